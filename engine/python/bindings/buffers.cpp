#include "buffers.h"

#include "errors.h"

namespace weft::python {

namespace {

void check_shape(const py::array& array, std::size_t count, const std::string& name) {
  if (array.ndim() != 2 || array.shape(0) != static_cast<py::ssize_t>(count) ||
      array.shape(1) != 3) {
    refuse(name + ": shape " + shape_of(array) + " is not (" + std::to_string(count) + ", 3)");
  }
  if (!array.writeable()) refuse(name + ": cannot be written");
}

}  // namespace

std::span<Vec3> vectors_in(py::array& array, std::size_t count, const std::string& name) {
  check_shape(array, count, name);
  if (!py::isinstance<py::array_t<double>>(array) || !(array.flags() & py::array::c_style)) {
    refuse(name + ": neither float64 in C's order nor float32");
  }
  return {static_cast<Vec3*>(array.mutable_data()), count};
}

FloatVectors floats_in(py::array& array, std::size_t count, const std::string& name) {
  check_shape(array, count, name);
  constexpr py::ssize_t size = sizeof(float);
  const py::ssize_t stride = count > 1 ? array.strides(0) / size : 3;
  if (!is_float32(array) || array.strides(1) != size || stride < 3 ||
      (count > 1 && array.strides(0) % size != 0)) {
    refuse(name + ": not float32 with x, y and z side by side");
  }
  const std::size_t step = static_cast<std::size_t>(stride);
  const std::size_t floats = count == 0 ? 0 : (count - 1) * step + 3;
  return {{static_cast<float*>(array.mutable_data()), floats}, step};
}

}  // namespace weft::python
