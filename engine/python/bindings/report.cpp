#include <pybind11/stl.h>
#include <weft/cloth.h>

#include <cstdio>

#include "arrays.h"
#include "parts.h"

namespace weft::python {

namespace {

void add_report_enumerations(py::module_& m) {
  py::enum_<Status>(m, "Status", "How a step ended; see cloth.h.")
      .value("converged", Status::converged)
      .value("fixed_iterations", Status::fixed_iterations)
      .value("iteration_limit", Status::iteration_limit)
      .value("infeasible", Status::infeasible)
      .value("passed_through", Status::passed_through)
      .value("non_finite_input", Status::non_finite_input)
      .value("non_finite", Status::non_finite);
  py::enum_<Stage>(m, "Stage", "The stages of a step, in order.")
      .value("predict", Stage::predict)
      .value("find_contacts", Stage::find_contacts)
      .value("solve_positions", Stage::solve_positions)
      .value("commit", Stage::commit)
      .value("correct_velocities", Stage::correct_velocities)
      .value("report", Stage::report);
  m.def("committed", &committed, py::arg("status"), "Whether such a step changed the state.");
}

std::string description_of(const StepReport& report) {
  char line[160];
  std::snprintf(line, sizeof line,
                "<weft.StepReport: %s, max_strain %.3g, max_error %.3g, %d substeps>",
                std::string(name(report.status)).c_str(), report.max_strain, report.max_error,
                report.substeps);
  return line;
}

template <class Class>
void add_work(Class& report) {
  report.def_readonly("status", &StepReport::status, "a Status")
      .def_readonly("asleep", &StepReport::asleep, "no work was done")
      .def_readonly("substeps", &StepReport::substeps, "done")
      .def_readonly("halvings", &StepReport::halvings, "attempts that were rejected")
      .def_readonly("iterations", &StepReport::iterations, "passes over the position constraints")
      .def_readonly("direction_updates", &StepReport::direction_updates, "renewals of directions")
      .def_readonly("velocity_iterations", &StepReport::velocity_iterations,
                    "passes of the velocity loop")
      .def_readonly("visits", &StepReport::visits, "constraints whose error was looked at")
      .def_readonly("corrections", &StepReport::corrections, "impulses applied")
      .def_readonly("scheme_fallbacks", &StepReport::scheme_fallbacks,
                    "attempts that rattle left to the other scheme")
      .def_readonly("stage_seconds", &StepReport::stage_seconds, "s, of each Stage of the step");
}

template <class Class>
void add_errors(Class& report) {
  report.def_readonly("max_strain", &StepReport::max_strain, "recomputed from the positions")
      .def_readonly("rms_strain", &StepReport::rms_strain, "root mean square")
      .def_readonly("max_shear", &StepReport::max_shear, "rad")
      .def_readonly("max_error", &StepReport::max_error, "what `tolerance` bounds")
      .def_readonly("worst_constraint", &StepReport::worst_constraint,
                    "its number in the description, or kNoIndex")
      .def_readonly("worst_element", &StepReport::worst_element,
                    "likewise, of the largest strain or shear")
      .def_readonly("max_bending_error", &StepReport::max_bending_error)
      .def_readonly("max_anchor_error", &StepReport::max_anchor_error, "m")
      .def_readonly("open_seams", &StepReport::open_seams, "whose particles have not come together")
      .def_readonly("max_seam_gap", &StepReport::max_seam_gap, "m")
      .def_readonly("motion_error", &StepReport::motion_error, "m/s, estimated")
      .def_readonly("failed_particle", &StepReport::failed_particle,
                    "one that is not finite, or kNoIndex")
      .def_readonly("passed_particle", &StepReport::passed_particle,
                    "one that passed through, or kNoIndex");
}

template <class Class>
void add_contacts(Class& report) {
  report.def_readonly("contacts", &StepReport::contacts, "candidate pairs of spheres")
      .def_readonly("max_penetration", &StepReport::max_penetration, "m, beyond the thickness")
      .def_readonly("body_contacts", &StepReport::body_contacts, "pairs that touch")
      .def_readonly("contact_failures", &StepReport::contact_failures, "caught by verification")
      .def_readonly("zones", &StepReport::zones, "taken along by a body")
      .def_readonly("intersecting", &StepReport::intersecting, "that cross when the step ends")
      .def_readonly("seam_work", &StepReport::seam_work, "J")
      .def_readonly("energy_lost", &StepReport::energy_lost, "J")
      .def_readonly("pin_work", &StepReport::pin_work, "J")
      .def_readonly("body_work", &StepReport::body_work, "J")
      .def_readonly("friction_work", &StepReport::friction_work, "J");
}

}  // namespace

void add_report(py::module_& m) {
  add_report_enumerations(m);
  py::class_<StepReport> report(m, "StepReport", "What one step did and what it reached.");
  report.def("__repr__", &description_of);
  add_work(report);
  add_errors(report);
  add_contacts(report);
  py::class_<Strain>(m, "Strain", "Of all constraints and triangles of fabric.")
      .def_readonly("max", &Strain::max, "the largest")
      .def_readonly("rms", &Strain::rms, "root mean square")
      .def_readonly("worst_constraint", &Strain::worst_constraint,
                    "its number in the description, or kNoIndex")
      .def_readonly("max_shear", &Strain::max_shear, "rad")
      .def_readonly("worst_element", &Strain::worst_element,
                    "the triangle of the largest strain or shear");
  py::class_<Energy>(m, "Energy", "Of the particles that are not fixed.")
      .def_readonly("kinetic", &Energy::kinetic, "J")
      .def_readonly("potential", &Energy::potential, "J, zero at the origin")
      .def_readonly("elastic", &Energy::elastic, "J")
      .def("total", &Energy::total, "J, their sum");
}

}  // namespace weft::python
