#include "engine/solvers/small_steps/small_steps_layout.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/tuning.h"

namespace weft {

std::vector<std::uint32_t> slots_of(const ConstraintStore& s,
                                    std::span<const std::uint32_t> links) {
  const auto holds = [&](std::uint32_t c, std::uint32_t slot) {
    return s.a[c] == slot || s.b[c] == slot;
  };
  const std::uint32_t first = links.front();
  const bool forwards = links.size() == 1 || holds(links[1], s.b[first]);
  std::vector<std::uint32_t> slots{forwards ? s.a[first] : s.b[first]};
  for (const std::uint32_t c : links) slots.push_back(s.a[c] == slots.back() ? s.b[c] : s.a[c]);
  return slots;
}

std::vector<std::uint32_t> links_of(const YarnLayout& yarns, const simd::YarnBlock& block,
                                    std::size_t lane) {
  std::vector<std::uint32_t> links;
  for (std::size_t row = block.first; row < block.last; ++row) {
    const std::uint32_t c = yarns.constraint[row * kernels::kLanes + lane];
    if (c != kNoIndex) links.push_back(c);
  }
  return links;
}

/// A straight yarn between two fixed particles has a singular matrix. All others are regular, and a
/// compliance would only keep what happens at one end of a long yarn from the other.
double compliance_of_yarn(const Model& model, std::span<const std::uint32_t> slots) {
  const auto fixed = std::ranges::count_if(
      slots, [&](std::uint32_t slot) { return model.inverse_mass[slot] == 0; });
  return fixed < 2 ? tuning::kCompliance : tuning::kHeldCompliance;
}

std::size_t SmallStepsLayout::bytes() const {
  return yarns.bytes() + bytes_of(blocks) + bytes_of(constraint) + bytes_of(used) +
         bytes_of(springs) + bytes_of(multiplier_place) + bytes_of(batches) + bytes_of(tiles) +
         bytes_of(serial) + membrane.bytes() + bending.bytes() + anchors.bytes() + linkage.bytes() +
         items.bytes() + bytes_of(load.spans) + bytes_of(load.ways);
}

}  // namespace weft
