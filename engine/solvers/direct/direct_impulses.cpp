#include "engine/solvers/direct/direct_impulses.h"

namespace weft {
namespace {

using kernels::Vector;
using kernels::VectorsView;

/// Adds the errors that arise from moving particles out of their contacts.
void absorb_touches(DirectSystem& s) {
  for (const Tie& touch : s.touches) {
    for (const std::uint32_t row : s.layout.rows_at[touch.b]) {
      const double sigma = s.layout.a[row] == touch.b ? 1 : -1;
      s.lambda[row] += sigma * touch.error * dot(s.n(row), touch.n);
    }
  }
}

void factorise_free(const DirectSystem& s, DirectFactor& factor) {
  const DirectLayout& layout = s.layout;
  factor.factorise(
      [&](std::size_t e) {
        return layout.entry_weight[e] * dot(s.n(layout.entry_row[e]), s.n(layout.entry_with[e]));
      },
      [&](std::size_t k) { return layout.diagonal[k] + s.softness(layout.row_constraint[k]); });
}

void factorise_touched(const DirectSystem& s, DirectFactor& factor) {
  const DirectLayout& layout = s.layout;
  const auto along = [&](std::uint32_t p, Vector v) {
    return s.touch_of[p] == kNoIndex ? 0 : dot(v, s.touches[s.touch_of[p]].n);
  };
  factor.factorise(
      [&](std::size_t e) {
        const Vector nk = s.n(layout.entry_row[e]), nj = s.n(layout.entry_with[e]);
        const std::uint32_t p = layout.entry_slot[e];
        return layout.entry_weight[e] * (dot(nk, nj) - along(p, nk) * along(p, nj));
      },
      [&](std::size_t k) {
        const double at_a = along(layout.a[k], s.n(k)), at_b = along(layout.b[k], s.n(k));
        return layout.diagonal[k] + s.softness(layout.row_constraint[k]) -
               s.model.inverse_mass[layout.a[k]] * at_a * at_a -
               s.model.inverse_mass[layout.b[k]] * at_b * at_b;
      });
}

void clamp_rows(DirectSystem& s) {
  for (std::size_t row = 0; row < s.layout.rows(); ++row) {
    s.lambda[row] = s.clamped(s.layout.row_constraint[row], s.lambda[row]);
  }
}

void clamp_ties(DirectSystem& s, const DirectBodies& bodies) {
  for (Tie& tie : s.ties) tie.impulse = s.clamped(tie.index, bodies.impulse_of_tie(s, tie));
  for (Tie& second : s.seconds) {
    second.impulse = s.clamped(second.index, bodies.impulse_of_second(s, second));
  }
}

/// The impulse of a contact is what its particle lacks to move with the sphere after all other
/// impulses.
void clamp_touches(DirectSystem& s, const DirectBodies& bodies) {
  for (Tie& touch : s.touches) {
    Vector impulse{0, 0, 0};  // on the particle, from its rows and second contacts
    for (const Tie& second : s.seconds) {
      if (second.b == touch.b) impulse = impulse + second.impulse * second.n;
    }
    for (const std::uint32_t row : s.layout.rows_at[touch.b]) {
      const double sigma = s.layout.a[row] == touch.b ? 1 : -1;
      impulse = impulse - (sigma * s.lambda[row]) * s.n(row);
    }
    const double gap = touch.error + dot(touch.n, bodies.motion(s.layout, touch.a));
    touch.impulse =
        s.clamped(touch.index, gap / s.model.inverse_mass[touch.b] - dot(touch.n, impulse));
  }
}

/// Factorises the matrix only if a direction has turned: the factor serves for velocities after
/// positions, and for all solves of a step by scheme rattle.
void factorise(DirectSystem& s, DirectFactor& factor) {
  if (!s.turned) return;
  s.turned = false;
  s.touches.empty() ? factorise_free(s, factor) : factorise_touched(s, factor);
}

}  // namespace

bool solve_impulses(DirectSystem& system, DirectFactor& factor, DirectBodies& bodies) {
  absorb_touches(system);
  factorise(system, factor);
  factor.solve(system.lambda.data());
  if (!bodies.solve(system, factor)) return false;
  clamp_rows(system);
  clamp_ties(system, bodies);
  clamp_touches(system, bodies);
  return true;
}

void apply_impulses(const DirectSystem& s, VectorsView u) {
  const auto pull = [&](std::uint32_t a, std::uint32_t b, Vector impulse) {
    u.add(a, -s.model.inverse_mass[a] * impulse);
    u.add(b, s.model.inverse_mass[b] * impulse);
  };
  for (std::size_t row = 0; row < s.layout.rows(); ++row) {
    pull(s.layout.a[row], s.layout.b[row], s.lambda[row] * s.n(row));
  }
  for (const Tie& tie : s.ties) pull(tie.a, tie.b, tie.impulse * tie.n);
  for (const Tie& second : s.seconds) pull(second.a, second.b, second.impulse * second.n);
  for (const Tie& touch : s.touches) pull(touch.a, touch.b, touch.impulse * touch.n);
}

}  // namespace weft
