/// Structs of weft as NumPy records, for arrays of them.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "arrays.h"

namespace weft::python {

/// The record type that has the fields of T.
template <class T>
py::dtype record_type();

template <>
py::dtype record_type<Constraint>();
template <>
py::dtype record_type<BendingElement>();
template <>
py::dtype record_type<MembraneElement>();
template <>
py::dtype record_type<Anchor>();
template <>
py::dtype record_type<Seam>();
template <>
py::dtype record_type<BodyContact>();

/// An array (n) of the type, as C has it in memory; from records, or a list of tuples.
py::array record_array(py::handle value, const py::dtype& type, const std::string& field);

template <class T>
std::vector<T> records(py::handle value, const std::string& field) {
  static_assert(std::is_trivially_copyable_v<T>);
  const py::array array = record_array(value, record_type<T>(), field);
  std::vector<T> out(static_cast<std::size_t>(array.size()));
  if (!out.empty())
    std::memcpy(static_cast<void*>(out.data()), array.data(), out.size() * sizeof(T));
  return out;
}

template <class T>
py::array array_of_records(const std::vector<T>& values) {
  py::array out(record_type<T>(),
                std::vector<py::ssize_t>{static_cast<py::ssize_t>(values.size())});
  if (!values.empty()) std::memcpy(out.mutable_data(), values.data(), values.size() * sizeof(T));
  return read_only(out);
}

}  // namespace weft::python
