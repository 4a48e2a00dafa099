#include "engine/solvers/small_steps/small_steps.h"

#include <algorithm>

#include "engine/solvers/small_steps/reference_small_steps.h"
#include "engine/solvers/small_steps/simd_small_steps.h"

namespace weft {

bool are_slots(const Model& model, std::span<const std::uint32_t> slots) {
  return std::ranges::is_sorted(slots) && (slots.empty() || slots.back() < model.slots());
}

std::unique_ptr<SmallSteps> make_small_steps(const Model& model, const Settings& settings,
                                             const simd::Table& table) {
  if (settings.backend == Backend::reference)
    return std::make_unique<ReferenceSmallSteps>(model, settings, table);
  return std::make_unique<SmallStepsSolver>(model, settings, table);
}

}  // namespace weft
