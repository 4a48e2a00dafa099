#include "engine/solvers/small_steps/constraints_of_yarns.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/model/model.h"
#include "engine/ordering/yarns.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

std::vector<std::uint32_t> all_or_none(const Model& model, const WovenYarns& yarns) {
  std::vector<std::uint32_t> all(model.constraints.plain);
  std::iota(all.begin(), all.end(), 0u);
  const double links = static_cast<double>(all.size());
  if (links < tuning::kLeastLinks * static_cast<double>(yarns.yarns.size())) all.clear();
  return all;
}

/// m/N, per slot: the least of the constraints there.
std::vector<double> least_compliances(const Model& model) {
  const ConstraintStore& s = model.constraints;
  std::vector<double> least(model.slots(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < s.plain; ++c) {
    for (const std::uint32_t slot : {s.a[c], s.b[c]})
      least[slot] = std::min(least[slot], s.compliance[c]);
  }
  return least;
}

/// Two families hold a sheet in its plane. Constraints that are much softer and belong to neither
/// are left out.
std::vector<std::uint32_t> those_that_carry(const Model& model, const WovenYarns& yarns) {
  const ConstraintStore& s = model.constraints;
  const std::vector<double> least = least_compliances(model);
  const auto is_relieved = [&](std::uint32_t c) {
    return s.compliance[c] > tuning::kSofter * std::max(least[s.a[c]], least[s.b[c]]);
  };
  std::vector<std::uint32_t> carry;
  for (const Yarn& yarn : yarns.yarns) {
    const auto links = yarns.links_of(yarn);
    if (static_cast<double>(links.size()) < tuning::kLeastLinks) continue;
    for (const std::uint32_t c : links) {
      if (yarn.family < 2 || !is_relieved(c)) carry.push_back(c);
    }
  }
  std::ranges::sort(carry);
  return carry;
}

}  // namespace

std::vector<std::uint32_t> constraints_of_yarns(const Model& model) {
  const ConstraintStore& s = model.constraints;
  const WovenYarns yarns = find_yarns(initial_positions(model), links_of(s, s.plain));
  return s.has_springs() ? those_that_carry(model, yarns) : all_or_none(model, yarns);
}

}  // namespace weft
