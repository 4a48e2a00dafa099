/// Several steps as one report.
#pragma once

#include <weft/cloth.h>

namespace weft::tools {

/// Adds a step to the total of those before it: each field is summed up, or the largest, or the
/// last, as ReportField::over_steps says. Sums of int stop at the largest int.
void add_step(StepReport& total, const StepReport& step);

}  // namespace weft::tools
