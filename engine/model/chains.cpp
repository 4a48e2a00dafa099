#include "engine/model/chains.h"

#include <algorithm>
#include <vector>

#include "engine/model/model.h"
#include "engine/tuning.h"

namespace weft {

bool closes_few_loops(const Model& model) {
  const ConstraintStore& s = model.constraints;
  std::vector<bool> is_joined(model.slots());
  for (std::size_t c = 0; c < s.size(); ++c) is_joined[s.a[c]] = is_joined[s.b[c]] = true;
  const auto all = static_cast<double>(s.size());
  const auto joined = static_cast<double>(std::ranges::count(is_joined, true));
  return all - joined <= tuning::kChainLoops * all;
}

bool is_held_twice(const Model& model) {
  return std::ranges::any_of(model.holds,
                             [&](std::uint32_t slot) { return slot != model.holds.front(); });
}

/// Where a constraint may break all have a law, of compliance 0, since laws tell what constraints
/// carry. So do the links of chains that hang from one particle, without a law.
void Model::leave_out_compliances() {
  const bool are_rigid =
      std::ranges::all_of(constraints.compliance, [](double c) { return c == 0; });
  const bool are_chains = closes_few_loops(*this) && !is_held_twice(*this);
  if (are_rigid && (constraints.strength.empty() || are_chains)) constraints.compliance = {};
}

}  // namespace weft
