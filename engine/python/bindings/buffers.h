/// Arrays of the caller that reads fill.
#pragma once

#include <weft/cloth.h>

#include <string>

#include "arrays.h"

namespace weft::python {

/// An array (count, 3) of float64, in C's order, that may be written.
std::span<Vec3> vectors_in(py::array& array, std::size_t count, const std::string& name);
/// An array (count, 3) of float32 that may be written; rows may be apart, as in buffer[:, :3].
FloatVectors floats_in(py::array& array, std::size_t count, const std::string& name);

inline bool is_float32(const py::array& array) { return py::isinstance<py::array_t<float>>(array); }

}  // namespace weft::python
