#include "engine/solvers/direct/direct_stiff.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/solvers/direct/direct_layout.h"
#include "engine/solvers/direct/direct_measure.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::LoopResult;
using kernels::Vector;
using kernels::VectorsView;

Vector operator*(const Symmetric& s, Vector v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}

Symmetric inverse(const Symmetric& s) {
  const double xx = s.yy * s.zz - s.yz * s.yz, xy = s.xz * s.yz - s.xy * s.zz,
               xz = s.xy * s.yz - s.xz * s.yy;
  const double f = 1 / (s.xx * xx + s.xy * xy + s.xz * xz);
  return {f * xx, f * (s.xx * s.zz - s.xz * s.xz), f * (s.xx * s.yy - s.xy * s.xy), f * xy,
          f * xz, f * (s.xy * s.xz - s.xx * s.yz)};
}

/// The imbalance first grows by orders of magnitude, so that only the number of solves can bound
/// the work.
int most_solves(const DirectLayout& layout) {
  const std::size_t most = tuning::kMostStiffWork / (layout.fronts.values + 1);
  return static_cast<int>(std::clamp<std::size_t>(most, 100, tuning::kMostStiffSolves));
}

}  // namespace

DirectStiff::DirectStiff(const Model& model) {
  if (model.uneven.ratio < tuning::kNearlyEqualMasses || !model.direct().bodies.empty() ||
      model.has_spheres())
    return;
  soft_.resize(model.slots());
}

DirectOutcome DirectStiff::iterate(DirectSystem& system, DirectFactor& factor,
                                   DirectBalance& balance, VectorsView x,
                                   const SphereContacts& contacts, int max_iterations,
                                   LoopResult& result) {
  const Model& model = system.model;
  const int most = most_solves(system.layout);
  for (int solves = 0;; ++solves) {
    const double worst = measure_positions(system, x, {}, contacts);
    result.visits += system.count();
    const double imbalance = balance.find(system, x);
    if (worst <= 0.5 && imbalance <= 0.1) {
      for (std::size_t p = 0; p < model.slots(); ++p)
        x.add(p, -model.inverse_mass[p] * balance.g()[p]);
      if (measure_positions(system, x, {}, contacts) <= 1) return DirectOutcome::converged;
      balance.find(system, x);
    }
    if (!std::isfinite(worst + imbalance) || solves == most) return DirectOutcome::failed;
    if (result.iterations >= max_iterations) return DirectOutcome::exhausted;
    ++result.iterations;
    ++result.direction_updates;
    result.corrections += system.active;
    stiffen(system);
    solve(system, factor, balance.g(), x);
  }
}

/// Sets W~ = (M + sum of k (1 - n n^T))^-1 for each particle.
void DirectStiff::stiffen(const DirectSystem& system) {
  const Model& model = system.model;
  const DirectLayout& layout = system.layout;
  for (std::size_t p = 0; p < model.slots(); ++p) {
    const double w = model.inverse_mass[p];
    const double m = w > 0 ? 1 / w : 0;
    soft_[p] = {m, m, m, 0, 0, 0};
  }
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    const std::uint32_t c = layout.row_constraint[row];
    const double k = 2 * std::abs(system.total[c]) / model.constraints.rest_length[c];
    const auto [x, y, z] = system.n(row);
    for (const std::uint32_t p : {layout.a[row], layout.b[row]}) {
      Symmetric& s = soft_[p];
      s.xx += k * (1 - x * x);
      s.yy += k * (1 - y * y);
      s.zz += k * (1 - z * z);
      s.xy -= k * x * y;
      s.xz -= k * x * z;
      s.yz -= k * y * z;
    }
  }
  for (std::size_t p = 0; p < model.slots(); ++p) {
    soft_[p] = model.inverse_mass[p] > 0 ? inverse(soft_[p]) : Symmetric{};
  }
}

void DirectStiff::solve(DirectSystem& system, DirectFactor& factor, kernels::Vectors& g,
                        VectorsView x) {
  const DirectLayout& layout = system.layout;
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    const std::uint32_t a = layout.a[row], b = layout.b[row];
    system.lambda[row] -= dot(system.n(row), soft_[a] * g[a] - soft_[b] * g[b]);
  }
  factor.factorise(
      [&](std::size_t e) {
        const Vector softened = soft_[layout.entry_slot[e]] * system.n(layout.entry_row[e]);
        const double value = dot(system.n(layout.entry_with[e]), softened);
        return layout.entry_weight[e] > 0 ? value : -value;
      },
      [&](std::size_t k) {
        const Vector nk = system.n(k);
        const double d = dot(nk, soft_[layout.a[k]] * nk) + dot(nk, soft_[layout.b[k]] * nk);
        return (d > 0 ? d : layout.diagonal[k]) + system.softness(layout.row_constraint[k]);
      });
  system.turned = true;
  factor.solve(system.lambda.data());
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    const double impulse = system.clamped(layout.row_constraint[row], system.lambda[row]);
    g.view().add(layout.a[row], impulse * system.n(row));
    g.view().add(layout.b[row], -impulse * system.n(row));
  }
  for (std::size_t p = 0; p < system.model.slots(); ++p) x.add(p, -1 * (soft_[p] * g[p]));
}

std::size_t DirectStiff::bytes() const { return bytes_of(soft_); }

}  // namespace weft
