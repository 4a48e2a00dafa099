#include <pybind11/stl.h>
#include <weft/report_fields.h>

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

/// "<weft.StepReport: converged, substeps 3, max_strain 0.001>": the status, and the fields that
/// differ from those of a step that did nothing.
std::string description_of(const StepReport& report) {
  std::string text = "<weft.StepReport: " + std::string(name(report.status));
  for_each_report_field([&]<class T>(const ReportField<T>& field) {
    const T& value = report.*field.member;
    if (std::is_same_v<T, Status> || value == StepReport{}.*field.member) return;
    text += ", " + std::string(field.name) + " " +
            py::str("{!r}").format(value).template cast<std::string>();
  });
  return text + ">";
}

}  // namespace

void add_report(py::module_& m) {
  add_report_enumerations(m);
  py::class_<ContactMs>(m, "ContactMs", "ms, that contacts with bodies took in a step.")
      .def_readonly("find", &ContactMs::find, "which may touch")
      .def_readonly("sweep", &ContactMs::sweep, "pushing apart")
      .def_readonly("verify", &ContactMs::verify, "whether something went through, and stopping it")
      .def("__repr__", [](const ContactMs& ms) {
        return py::str("<weft.ContactMs: find {:.3g}, sweep {:.3g}, verify {:.3g}>")
            .format(ms.find, ms.sweep, ms.verify);
      });
  py::class_<StepReport> report(m, "StepReport", "The work of one step and the errors at its end.");
  report.def("__repr__", &description_of);
  for_each_report_field(
      [&](const auto& field) { report.def_readonly(field.name, field.member, field.text); });
  py::class_<Strain>(m, "Strain", "Strain of all constraints and triangles of fabric.")
      .def_readonly("max", &Strain::max, "the largest")
      .def_readonly("rms", &Strain::rms, "root mean square")
      .def_readonly("worst_constraint", &Strain::worst_constraint,
                    "its number in the description, or kNoIndex")
      .def_readonly("max_shear", &Strain::max_shear, "rad")
      .def_readonly("worst_element", &Strain::worst_element,
                    "the triangle of the largest strain or shear");
  py::class_<PressureNow>(m, "PressureNow", "A Pressure of a cloth as it is.")
      .def_readonly("pressure", &PressureNow::pressure, "Pa, more than the air around has")
      .def_readonly("volume", &PressureNow::volume,
                    "m^3, that its triangles enclose; 0 if they do not close");
  py::class_<Energy>(m, "Energy", "Energy of the particles that are not fixed.")
      .def_readonly("kinetic", &Energy::kinetic, "J")
      .def_readonly("potential", &Energy::potential, "J, zero at the origin")
      .def_readonly("elastic", &Energy::elastic, "J")
      .def("total", &Energy::total, "J, their sum");
}

}  // namespace weft::python
