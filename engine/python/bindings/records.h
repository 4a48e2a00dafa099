/// Structs of weft as NumPy records, for arrays of them.
#pragma once

#include <weft/scene_fields.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "arrays.h"

namespace weft::python {

/// The fields of a struct, by their places in it.
class RecordFields {
 public:
  template <class Element, class Value>
  void add(const char* name, Value Element::*member) {
    static const Element kOne{};
    const auto* begin = reinterpret_cast<const std::byte*>(&kOne);
    const auto* at = reinterpret_cast<const std::byte*>(&(kOne.*member));
    add(name, format_of(Value{}), at - begin);
  }
  py::dtype type(std::size_t size) const;

 private:
  static std::string format_of(std::uint32_t) { return "u4"; }
  static std::string format_of(double) { return "f8"; }
  static std::string format_of(ConstraintKind) { return "u1"; }
  static std::string format_of(Tear) { return "u1"; }
  static std::string format_of(Vec3) { return "3f8"; }
  template <class T, std::size_t n>
  static std::string format_of(const std::array<T, n>&) {
    return std::to_string(n) + format_of(T{});
  }
  template <std::size_t rows, std::size_t n>
  static std::string format_of(const std::array<std::array<double, n>, rows>&) {
    return "(" + std::to_string(rows) + "," + std::to_string(n) + ")f8";
  }
  void add(const char* name, const std::string& format, std::ptrdiff_t offset);

  py::list names_, formats_, offsets_;
};

/// The record type that has the fields of T.
template <class T>
py::dtype record_type() {
  RecordFields fields;
  for_each_element_field<T>([&](const auto& field) { fields.add(field.name, field.member); });
  return fields.type(sizeof(T));
}
template <>
py::dtype record_type<BodyContact>();
template <>
py::dtype record_type<Torn>();

struct RecordDefaults {
  py::bytes bytes;       ///< of one record
  std::size_t optional;  ///< so many of its last fields may be left out
};

/// Fields at the end may be left out as in a scene file.
template <class T>
RecordDefaults record_defaults() {
  const T one{};
  std::size_t optional = 0;
  for_each_element_field<T>(
      [&](const auto& field) { optional = field.given == weft::Given::maybe ? optional + 1 : 0; });
  return {py::bytes(reinterpret_cast<const char*>(&one), sizeof(T)), optional};
}

/// An array (n) of the type, as C has it in memory; from records, or a list of tuples.
py::array record_array(py::handle value, const py::dtype& type, const std::string& field,
                       const RecordDefaults& defaults);

template <class T>
std::vector<T> records(py::handle value, const std::string& field) {
  static_assert(std::is_trivially_copyable_v<T>);
  const py::array array = record_array(value, record_type<T>(), field, record_defaults<T>());
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
