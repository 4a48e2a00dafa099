/// Classes of plain fields: they are made of keywords, and a value that does not fit is refused in
/// one line which names the field, the value and what was expected.
#pragma once

#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.h"

namespace weft::python {

/// A value for something of type V, which taken() takes.
template <class V>
struct Given {
  py::object value;
};

/// The kind of value that V takes, in a message.
template <class V>
struct Expected {
  static std::string text() {
    if constexpr (std::is_same_v<V, bool>) {
      return "True or False";
    } else if constexpr (std::is_integral_v<V>) {
      return "a whole number that fits";
    } else if constexpr (std::is_floating_point_v<V>) {
      return "a number";
    } else {
      const py::object type = py::type::of<V>();
      const std::string name = "a " + py::str(type.attr("__name__")).template cast<std::string>();
      if (!std::is_enum_v<V>) return name;
      const py::object names = py::str(", ").attr("join")(type.attr("__members__"));
      return name + ": " + py::str(names).template cast<std::string>();
    }
  }
};
template <>
struct Expected<Vec3> {
  static std::string text() { return "three numbers"; }
};
template <>
struct Expected<Rotation> {
  static std::string text() { return "four numbers x, y, z, w"; }
};
template <std::size_t kCount>
struct Expected<std::array<double, kCount>> {
  static std::string text() { return "a list of " + std::to_string(kCount) + " numbers"; }
};
template <class V>
struct Expected<std::optional<V>> {
  static std::string text() { return Expected<V>::text() + ", or None"; }
};
template <class V>
struct Expected<std::vector<V>> {
  static std::string text() { return "a list, each of it " + Expected<V>::text(); }
};

template <class V>
V taken(const Given<V>& given, const std::string& field) {
  py::detail::make_caster<V> caster;
  if (!caster.load(given.value, true)) {
    PyErr_Clear();
    refuse(field + ": " + py::repr(given.value).template cast<std::string>() + " is not " +
           Expected<V>::text());
  }
  return py::detail::cast_op<V>(std::move(caster));
}

/// A field of a class that has no more than some of them.
template <class T, class Part>
void add_field(py::class_<T>& type, const char* name, Part part, const char* text) {
  using V = std::remove_reference_t<std::invoke_result_t<Part, T&>>;
  type.def_property(
      name, [part](T& t) -> V& { return std::invoke(part, t); },
      [part, name](T& t, const Given<V>& v) { std::invoke(part, t) = taken(v, name); }, text);
}

/// How a field looks in the representation of an object: of an array its shape.
inline std::string shown(const py::object& value) {
  if (py::isinstance<py::array>(value)) {
    const py::array array = value;
    if (array.ndim() != 1 || array.size() > 4 || array.dtype().kind() == 'V')
      return "<array " + shape_of(array) + ">";
    return py::str(value.attr("tolist")()).cast<std::string>();
  }
  const bool is_enumeration = py::hasattr(value, "__members__");
  return (is_enumeration ? py::str(value) : py::repr(value)).cast<std::string>();
}

/// A class with the constructor T(field=value, ...): the defaults of T, and these fields. Its
/// representation has those that differ from the defaults.
template <class T>
class Fields : public py::class_<T> {
 public:
  Fields(py::handle scope, const char* name, const char* text) : py::class_<T>(scope, name, text) {
    this->def(py::init(&made_of), "The defaults, but for the fields that are given by name.");
    this->def("__repr__", &description_of);
  }
  /// part: a member, or what returns a reference to a part of one.
  template <class Part>
  Fields& field(const char* name, Part part, const char* text) {
    add_field(*this, name, part, text);
    return note(name);
  }
  /// Whole arrays are read and assigned. in_messages: the field's name there.
  template <class E>
  Fields& array(const char* name, std::vector<E> T::*member, const char* text,
                std::string in_messages = "") {
    if (in_messages.empty()) in_messages = name;
    this->def_property(
        name, [member](const T& t) { return rows<NumberOf<E>>(t.*member); },
        [member, in_messages](T& t, py::object v) { t.*member = elements<E>(v, in_messages); },
        text);
    return note(name);
  }
  /// Any other property.
  template <class Get, class Set>
  Fields& property(const char* name, Get&& get, Set&& set, const char* text) {
    this->def_property(name, std::forward<Get>(get), std::forward<Set>(set), text);
    return note(name);
  }

 private:
  Fields& note(const char* name) {
    names_.push_back(name);
    return *this;
  }
  static std::string description_of(const py::object& self) {
    const py::object type = py::type::of(self), plain = type();
    std::string list;
    for (const char* name : names_) {
      const std::string value = shown(self.attr(name));
      if (value != shown(plain.attr(name)))
        list += (list.empty() ? "" : ", ") + std::string(name) + "=" + value;
    }
    return "weft." + type.attr("__name__").template cast<std::string>() + "(" + list + ")";
  }
  static std::unique_ptr<T> made_of(const py::kwargs& fields) {
    auto made = std::make_unique<T>();
    py::object self = py::cast(made.get(), py::return_value_policy::reference);
    for (const auto& [name, value] : fields) {
      if (!py::hasattr(self, name)) {
        refuse(py::str("{} has no field {}")
                   .format(py::type::of(self).attr("__name__"), name)
                   .template cast<std::string>());
      }
      py::setattr(self, name, value);
    }
    return made;
  }

  inline static std::vector<const char*> names_;
};

}  // namespace weft::python

namespace pybind11::detail {

/// Takes all there is. Signatures show V.
template <class V>
struct type_caster<weft::python::Given<V>> {
  PYBIND11_TYPE_CASTER(weft::python::Given<V>, make_caster<V>::name);
  bool load(handle source, bool) {
    value.value = reinterpret_borrow<object>(source);
    return true;
  }
};

}  // namespace pybind11::detail
