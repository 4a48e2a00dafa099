/// The parts of the module, each in the file of its name.
#pragma once

#include <pybind11/pybind11.h>

namespace weft::python {

void add_records(pybind11::module_& m);
void add_scene(pybind11::module_& m);
void add_settings(pybind11::module_& m);
void add_mesh(pybind11::module_& m);
void add_body(pybind11::module_& m);
void add_report(pybind11::module_& m);
void add_cloth(pybind11::module_& m);
void add_batch(pybind11::module_& m);
void add_surface(pybind11::module_& m);

}  // namespace weft::python
