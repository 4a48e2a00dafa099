#include "engine/step/report_errors.h"

#include <algorithm>

#include "engine/measure/state_measure.h"
#include "engine/step/reporting.h"

namespace weft {

double largest_rigid_strain(const State& s) {
  const ConstraintStore& store = s.model->constraints;
  double most = 0;
  for (std::size_t c = 0; c < store.size(); ++c) {
    if (store.compliance[c] == 0) most = std::max(most, strain_of(*s.model, s.position, c));
  }
  return most;
}

void report_errors(State& s, kernels::Vectors& x, bool ends, StepReport& report, Team& team) {
  Strain strain = s.measure->strain(x.view(), team);
  if (!s.model->constraints.has_springs())
    report.max_error = strain.max;
  else if (!committed(report.status))
    report.max_error = largest_rigid_strain(s);
  add_membrane_strain(*s.model, x, strain);
  report.max_strain = strain.max;
  report.rms_strain = strain.rms;
  report.worst_constraint = strain.worst_constraint;
  report.max_shear = strain.max_shear;
  report.worst_element = strain.worst_element;
  report.contacts = static_cast<int>(s.contacts.count());
  report.max_penetration = s.measure->penetration(x.view(), s.contacts);
  report.max_anchor_error = s.anchors.largest_excess(s.model->anchors, x, ends);
}

}  // namespace weft
