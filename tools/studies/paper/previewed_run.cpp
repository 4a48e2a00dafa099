#include "tools/studies/paper/previewed_run.h"

#include <algorithm>
#include <utility>

#include "engine/isa.h"
#include "engine/step/previewed_sweeps.h"
#include "engine/step/state.h"
#include "engine/step/step.h"

namespace weft::tools::paper {

Result<RunSummary> run_previewed(std::shared_ptr<const Model> model, const Settings& settings,
                                 const RunPlan& plan,
                                 const std::function<void(int frame)>& on_frame) {
  const auto isa = resolve(settings.isa);  // contacts are found in lanes
  if (!isa) return Error{isa.error()};
  Settings resolved = settings;
  resolved.isa = isa.value();
  resolved.solver = Solver::gauss_seidel;
  State state(std::move(model), resolved);
  PreviewedSweeps previewed(state);
  state.solver = &previewed;

  RunSummary summary;
  summary.solver = state.settings.solver;
  summary.scheme = state.settings.scheme;
  summary.isa = state.settings.isa;
  while (summary.frames < plan.steps && committed(summary.total.status)) {
    const StepReport report = step(state, plan.dt);
    add_frame(summary, report);
    summary.max_strain = std::max(summary.max_strain, report.max_strain);
    on_frame(summary.frames);
  }
  return summary;
}

}  // namespace weft::tools::paper
