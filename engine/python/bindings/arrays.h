/// NumPy arrays to what weft takes and back. Arrays that are returned are copies which cannot be
/// written, since that would not change the field.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <weft/body.h>
#include <weft/scene.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "errors.h"

namespace weft::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

/// The numbers of an array (n, width), or (n) where the width is 1. An empty one may have any
/// shape.
inline Doubles doubles(py::handle value, const std::string& field, py::ssize_t width) {
  const Doubles array = Doubles::ensure(value);
  if (!array) {
    PyErr_Clear();
    refuse(field + ": not an array of numbers");
  }
  const bool fits = width == 1 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == width;
  if (array.size() > 0 && !fits) {
    refuse(field + ": shape " + shape_of(array) + " is not (n" +
           (width == 1 ? ",)" : ", " + std::to_string(width) + ")"));
  }
  return array;
}

/// T: some doubles and nothing else.
template <class T>
std::vector<T> vectors(py::handle value, const std::string& field) {
  static_assert(sizeof(T) % sizeof(double) == 0);
  constexpr py::ssize_t width = sizeof(T) / sizeof(double);
  const Doubles array = doubles(value, field, width);
  std::vector<T> out(static_cast<std::size_t>(array.size() / width));
  if (!out.empty())
    std::memcpy(static_cast<void*>(out.data()), array.data(), out.size() * sizeof(T));
  return out;
}

/// Whole numbers of 0 to 2^32 - 1, of any shape, row by row.
std::vector<std::uint32_t> indices(py::handle value, const std::string& field);
/// The same of an array (n, width).
std::vector<std::uint32_t> index_rows(py::handle value, const std::string& field,
                                      py::ssize_t width);

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> index_tuples(py::handle value, const std::string& field) {
  const std::vector<std::uint32_t> flat = index_rows(value, field, N);
  std::vector<std::array<std::uint32_t, N>> out(flat.size() / N);
  if (!out.empty()) std::memcpy(out.data(), flat.data(), flat.size() * sizeof(std::uint32_t));
  return out;
}

inline py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// The numbers that a T consists of, and nothing else.
template <class T>
struct NumbersOf {
  using Type = double;
};
template <>
struct NumbersOf<std::uint32_t> {
  using Type = std::uint32_t;
};
template <std::size_t N>
struct NumbersOf<std::array<std::uint32_t, N>> {
  using Type = std::uint32_t;
};
template <class T>
using NumberOf = typename NumbersOf<T>::Type;

template <class T>
std::vector<T> elements(py::handle value, const std::string& field) {
  if constexpr (std::is_same_v<NumberOf<T>, double>)
    return vectors<T>(value, field);
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return indices(value, field);
  else
    return index_tuples<std::tuple_size_v<T>>(value, field);
}

/// T: some numbers of type Number and nothing else.
template <class Number, class T>
py::array rows(const std::vector<T>& values) {
  constexpr std::size_t width = sizeof(T) / sizeof(Number);
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size())};
  if (width > 1) shape.push_back(width);
  py::array_t<Number> out(shape);
  if (!values.empty()) std::memcpy(out.mutable_data(), values.data(), values.size() * sizeof(T));
  return read_only(out);
}

}  // namespace weft::python

namespace pybind11::detail {

/// Three numbers; a read-only array of them on the way back.
template <>
struct type_caster<weft::Vec3> {
  PYBIND11_TYPE_CASTER(weft::Vec3, const_name("numpy.ndarray"));
  bool load(handle source, bool) {
    const auto array = weft::python::Doubles::ensure(source);
    if (!array) return PyErr_Clear(), false;
    if (array.ndim() != 1 || array.size() != 3) return false;
    value = {array.at(0), array.at(1), array.at(2)};
    return true;
  }
  static handle cast(const weft::Vec3& v, return_value_policy, handle) {
    array_t<double> out(3);
    std::memcpy(out.mutable_data(), &v, sizeof v);
    return weft::python::read_only(std::move(out)).release();
  }
};

/// Four numbers x, y, z, w; a read-only array of them on the way back.
template <>
struct type_caster<weft::Rotation> {
  PYBIND11_TYPE_CASTER(weft::Rotation, const_name("numpy.ndarray"));
  bool load(handle source, bool) {
    const auto array = weft::python::Doubles::ensure(source);
    if (!array) return PyErr_Clear(), false;
    if (array.ndim() != 1 || array.size() != 4) return false;
    value = {array.at(0), array.at(1), array.at(2), array.at(3)};
    return true;
  }
  static handle cast(const weft::Rotation& q, return_value_policy, handle) {
    array_t<double> out(4);
    std::memcpy(out.mutable_data(), &q, sizeof q);
    return weft::python::read_only(std::move(out)).release();
  }
};

}  // namespace pybind11::detail
