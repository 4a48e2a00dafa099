/// Saved bytes in Python's.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace weft::python {

inline pybind11::bytes to_python(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
/// The bytes of a bytearray, an array, a mapped file and the like are copied: others may change
/// them meanwhile.
inline pybind11::bytes whole(const pybind11::buffer& buffer) {
  if (PyBytes_Check(buffer.ptr())) return pybind11::reinterpret_borrow<pybind11::bytes>(buffer);
  PyObject* const copy = PyBytes_FromObject(buffer.ptr());
  if (copy == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::bytes>(copy);
}
/// Valid as long as the object, which is immutable.
inline std::span<const std::byte> bytes_of(const pybind11::bytes& bytes) {
  const std::string_view view = bytes;
  return std::as_bytes(std::span(view));
}

}  // namespace weft::python
