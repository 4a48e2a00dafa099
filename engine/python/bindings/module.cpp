// weft._weft, which the package weft shows.
#include <weft/weft.h>

#include <string>

#include "errors.h"
#include "parts.h"

PYBIND11_MODULE(_weft, m) {
  using namespace weft::python;
  m.doc() = "weft: a cloth simulation library.";
  auto error = pybind11::register_exception<Refusal>(m, "Error", PyExc_ValueError);
  error.doc() = "One line that names the field, the index and the value that were refused.";
  m.attr("__version__") = std::to_string(WEFT_VERSION_MAJOR) + "." +
                          std::to_string(WEFT_VERSION_MINOR) + "." +
                          std::to_string(WEFT_VERSION_PATCH);
  m.attr("kNoIndex") = weft::kNoIndex;
  add_records(m);
  add_scene(m);
  add_settings(m);
  add_mesh(m);
  add_body(m);
  add_report(m);
  add_cloth(m);
  add_batch(m);
  add_surface(m);
}
