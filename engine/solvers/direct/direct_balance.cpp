#include "engine/solvers/direct/direct_balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/solvers/direct/direct_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;
using kernels::VectorsView;

}  // namespace

void DirectBalance::start(VectorsView x) {
  for (std::size_t p = 0; p < predicted_.size(); ++p) predicted_.set(p, x[p]);
}

double DirectBalance::find(const DirectSystem& system, VectorsView x) {
  const Model& model = system.model;
  const DirectLayout& layout = system.layout;
  for (std::size_t p = 0; p < model.slots(); ++p) {
    const double w = model.inverse_mass[p];
    g_.set(p, w > 0 ? (1 / w) * (x[p] - predicted_[p]) : Vector{0, 0, 0});
  }
  double shortest = std::numeric_limits<double>::infinity();
  const auto pull = [&](std::uint32_t index, std::uint32_t a, std::uint32_t b, Vector n) {
    const Vector j = system.total[index] * n;
    g_.view().add(a, j);
    g_.view().add(b, -1 * j);
    shortest = std::min(shortest, system.tolerance(index));
  };
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    pull(layout.row_constraint[row], layout.a[row], layout.b[row], system.n(row));
  }
  for (const auto* list : {&system.ties, &system.seconds, &system.touches}) {
    for (const Tie& tie : *list) pull(tie.index, tie.a, tie.b, tie.n);
  }
  double worst = 0;
  for (std::size_t p = 0; p < model.slots(); ++p) {
    const double moved = model.inverse_mass[p] * length(g_[p]);
    if (!std::isfinite(moved)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, moved);
  }
  return worst / shortest;
}

bool DirectBalance::is_explained(const DirectSystem& system, VectorsView x) {
  if (find(system, x) <= tuning::kNegligibleImbalance) return true;
  double unexplained = 0, motion = 0;
  for (std::size_t p = 0; p < g_.size(); ++p) {
    const double w = system.model.inverse_mass[p];
    if (w == 0) continue;
    const Vector d = x[p] - predicted_[p];
    unexplained += w * dot(g_[p], g_[p]);
    motion += dot(d, d) / w;
  }
  return unexplained <= tuning::kMostUnexplained * tuning::kMostUnexplained * motion;
}

}  // namespace weft
