#include "engine/solvers/sweeps/simd_solver.h"

#include <algorithm>

#include "engine/solvers/sweeps/simd_loop.h"

namespace weft {
namespace {

/// Floats see an error fall by some seven digits; renewing takes it from there (iterative
/// refinement).
constexpr int kOldestDirections = 1024;

kernels::LoopLimits not_too_old(kernels::LoopLimits limits) {
  if (limits.renew_after == 0) limits.renew_after = kOldestDirections;
  return limits;
}

}  // namespace

kernels::LoopResult SimdSolver::solve_positions(kernels::VectorsView x, kernels::VectorsView start,
                                                const SphereContacts& store, SpringLaws* laws,
                                                bool first_round, const kernels::LoopLimits& limits,
                                                Team& team) {
  if (first_round) std::ranges::fill(s_.impulse_, 0.f);
  if (laws != nullptr) s_.take_laws(*laws, first_round);
  if (s_.model_.has_spheres()) {
    const double tau = s_.settings_.iterations > 0 ? 1 : s_.settings_.contact_tolerance;
    s_.place_contacts(store, tau, !first_round);
  }
  const auto directions = s_.settings_.measuring.directions == Directions::frozen
                              ? kernels::Directions::frozen
                              : kernels::Directions::each;
  SimdLoop loop(s_, {.x = x, .start = start}, team);
  const auto result = kernels::iterate(loop, directions, not_too_old(limits));
  if (laws != nullptr) {
    s_.renew_multipliers();
    s_.keep_multipliers(*laws);
  }
  for (const ContactLanes::Range& range : s_.contacts_.spheres) {
    for (std::size_t k = range.first; k < range.first + range.real; ++k) {
      s_.contact_impulse_[s_.contacts_.contact[k]] = s_.contacts_.impulse[k];
    }
  }
  return result;
}

/// The directions stay, but are "renewed" like frozen ones: it is the renewal that takes the errors
/// anew from the velocities, in double. Without it no error could fall below 10^-7 of the first.
kernels::LoopResult SimdSolver::correct_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                                   const SphereContacts& store,
                                                   const kernels::LoopLimits& limits, Team& team) {
  std::ranges::fill(s_.impulse_, 0.f);
  if (s_.model_.has_spheres()) {
    s_.place_contacts(store, s_.settings_.iterations > 0 ? 1 : s_.settings_.velocity_tolerance,
                      false);
  }
  s_.choose_active(x);
  SimdLoop loop(s_, {.x = x, .v = v}, team);
  return kernels::iterate(loop, kernels::Directions::frozen, not_too_old(limits));
}

}  // namespace weft
