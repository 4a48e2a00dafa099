/// The original method as the paper has it: both particles are previewed at every visit of a
/// constraint (kernels/reference/previewed.h). No Cloth offers it; here it is run on the engine's
/// own state, step by step as any other method.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <memory>

#include "tools/program/run/runner.h"

namespace weft::tools::paper {

/// Of the plan, dt and steps count; of the summary, what add_frame() gathers and the largest strain
/// are set. The settings must be those of the original: reference, Gauss-Seidel, scheme paper.
Result<RunSummary> run_previewed(std::shared_ptr<const Model> model, const Settings& settings,
                                 const RunPlan& plan,
                                 const std::function<void(int frame)>& on_frame);

}  // namespace weft::tools::paper
