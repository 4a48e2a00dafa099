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
/// Valid as long as the object, which nobody can change.
inline std::span<const std::byte> bytes_of(const pybind11::bytes& bytes) {
  const std::string_view view = bytes;
  return std::as_bytes(std::span(view));
}

}  // namespace weft::python
