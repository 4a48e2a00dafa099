/// Refuses settings, in one line of the form "field: reason (value)".
#pragma once

#include <weft/jobs.h>
#include <weft/result.h>
#include <weft/settings.h>

namespace weft {

class Model;

Result<void> validate(const Settings& settings);
/// For the simd backend: whether floats can square lengths and the tolerances that are used.
Result<void> validate_for_lanes(const Settings& settings, const Model& model);
/// Whether the solver that was chosen knows all that the model has.
Result<void> validate_for_solver(const Settings& resolved, const Model& model);
Result<void> validate(const JobSystem& jobs);

}  // namespace weft
