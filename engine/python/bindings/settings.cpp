#include <weft/settings.h>

#include "fields.h"
#include "parts.h"

namespace weft::python {

namespace py = pybind11;

namespace {

void add_setting_enumerations(py::module_& m) {
  py::enum_<Solver>(m, "Solver", "How constraints are solved; see settings.h.")
      .value("gauss_seidel", Solver::gauss_seidel)
      .value("direct", Solver::direct)
      .value("yarn", Solver::yarn)
      .value("small_steps", Solver::small_steps)
      .value("automatic", Solver::automatic);
  py::enum_<Scheme>(m, "Scheme", "How a step goes on in time; see settings.h.")
      .value("paper", Scheme::paper)
      .value("rattle", Scheme::rattle)
      .value("implicit", Scheme::implicit)
      .value("bdf2", Scheme::bdf2)
      .value("automatic", Scheme::automatic);
  py::enum_<Directions>(m, "Directions", "When directions are renewed; see settings.h.")
      .value("each", Directions::each)
      .value("frozen", Directions::frozen);
  py::enum_<Backend>(m, "Backend", "Scalar code in double, or lanes; see settings.h.")
      .value("reference", Backend::reference)
      .value("simd", Backend::simd);
  py::enum_<Isa>(m, "Isa", "The instructions of the simd backend; see settings.h.")
      .value("automatic", Isa::automatic)
      .value("sse2", Isa::sse2)
      .value("avx2", Isa::avx2)
      .value("avx512", Isa::avx512)
      .value("neon", Isa::neon);
}

/// A field of Settings::measuring, which Python has beside all others.
template <auto kField>
constexpr auto measured = [](Settings& settings) -> auto& {
  return settings.measuring.*kField;
};

}  // namespace

void add_settings(py::module_& m) {
  add_setting_enumerations(m);
  Fields<Settings> settings(m, "Settings",
                            "How a cloth is solved, and to which error; see settings.h.");
  settings
      .field("tolerance", &Settings::tolerance,
             "the strain that every step must reach; of springs and fabric, "
             "the distance from their laws")
      .field("substeps", &Settings::substeps, "0: automatic")
      .field("iterations", &Settings::iterations, "0: to the tolerance")
      .field("renew_after", measured<&Measuring::renew_after>,
             "iterations along the same directions")
      .field("max_iterations", &Settings::max_iterations, "of a whole step")
      .field("contact_tolerance", &Settings::contact_tolerance, "m")
      .field("velocity_tolerance", &Settings::velocity_tolerance, "m/s")
      .field("motion_tolerance", &Settings::motion_tolerance, "m/s, the allowed error; 0: off")
      .field("impulse_limit", measured<&Measuring::impulse_limit>, "N s; 0: none")
      .field("solver", &Settings::solver, "a Solver")
      .field("scheme", &Settings::scheme, "a Scheme")
      .field("backend", &Settings::backend, "a Backend")
      .field("isa", &Settings::isa, "an Isa")
      .field("threads", &Settings::threads, "most threads of an Arena; 0: all")
      .field("directions", measured<&Measuring::directions>, "Directions")
      .field("anticipate", measured<&Measuring::anticipate>, "section 4.2 of the paper")
      .field("anticipate_products", measured<&Measuring::anticipate_products>, "by stored products")
      .field("sleep", &Settings::sleep, "a cloth that rests costs nothing")
      .field("skip", measured<&Measuring::skip>, "section 4.3 of the paper")
      .field("velocity_correction", &Settings::velocity_correction, "a second loop");
  m.def("paper_settings", &paper_settings, "The settings of the paper: Gauss-Seidel, one substep.");
}

}  // namespace weft::python
