/// What classes of plain fields have in common: they are made of keywords.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace weft::python {

/// T(field=value, ...): the defaults of T, and these fields.
template <class T, class Class>
void add_keywords(Class& type) {
  namespace py = pybind11;
  type.def(py::init([](const py::kwargs& fields) {
             auto made = std::make_unique<T>();
             py::object self = py::cast(made.get(), py::return_value_policy::reference);
             for (const auto& [name, value] : fields) {
               if (!py::hasattr(self, name)) {
                 throw py::type_error(py::str("{} has no field {}")
                                          .format(py::type::of(self).attr("__name__"), name)
                                          .template cast<std::string>());
               }
               py::setattr(self, name, value);
             }
             return made;
           }),
           "The defaults, but for the fields that are given by name.");
}

}  // namespace weft::python
