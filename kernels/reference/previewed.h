/// The original method as the paper has it (3.2, with the formulation of 4.1). It keeps the
/// velocities of the particles, which impulses change. Whenever it looks at a constraint it
/// computes the previews of both ends anew (integrate.h):
///
///     p(t+h) = p + h v + h^2/2 a                               (paper eq. 2)
///     e = n . (p_a(t+h) - p_b(t+h)) - target
///     i = 1/h e / (w_a + w_b);   v_a -= w_a i n;   v_b += w_b i n
///
/// OriginalLoop (original.h) keeps p(t+h) instead and moves it by h times as much: the same
/// iterates up to rounding, for less work. Impulses are in the units of relaxation.h, lambda = h i.
#pragma once

#include "kernels/reference/integrate.h"
#include "kernels/reference/relaxation.h"

namespace weft::reference {

/// x are the previews, before and afterwards; motion.velocity is room for the velocities that lead
/// there.
template <Directions kDirections>
class PreviewedLoop {
 public:
  PreviewedLoop(const Relaxation& r, const Motion& motion, double h)
      : r_(r), motion_(motion), h_(h), per_h_(1 / h) {
    for (std::size_t i = 0; i < r_.particles; ++i) {
      const Vector mean = per_h_ * (r_.x[i] - motion_.position[i]);
      motion_.velocity.set(i, mean - (0.5 * h_) * acceleration(motion_, i));
    }
  }

  void renew() {
    for (std::size_t c = 0; c < r_.count; ++c) renew_direction(r_, c, previewed_vector(c));
  }

  Sweep sweep() {
    Sweep sweep{static_cast<std::int64_t>(r_.count), 0};
    for (std::size_t c = 0; c < r_.bilateral; ++c) sweep.corrections += visit_bilateral(c);
    for (std::size_t c = r_.bilateral; c < r_.count; ++c) sweep.corrections += visit_unilateral(c);
    return sweep;
  }

  void finish() {
    for (std::size_t i = 0; i < r_.particles; ++i) r_.x.set(i, preview(motion_, i, h_));
  }

 private:
  Vector previewed_vector(std::size_t c) const {
    return preview(motion_, r_.a[c], h_) - preview(motion_, r_.b[c], h_);
  }

  bool visit_bilateral(std::size_t c) {
    const double change = impulse_change(r_, c, error(r_, c, previewed_vector(c)), 0);
    if (change == 0) return false;
    accumulate(r_, c, change);
    push(c, change);
    return true;
  }

  bool visit_unilateral(std::size_t c) {
    const double e = error(r_, c, previewed_vector(c));
    const double change = impulse_change(r_, c, e, r_.impulse[c]);
    if (change == 0) return false;
    r_.impulse[c] += change;
    push(c, change);
    return true;
  }

  void push(std::size_t c, double change) {
    const std::size_t a = r_.a[c], b = r_.b[c];
    const Vector i = (per_h_ * change) * r_.n[c];
    motion_.velocity.add(a, -r_.inverse_mass[a] * i);
    motion_.velocity.add(b, r_.inverse_mass[b] * i);
  }

  const Relaxation& r_;
  const Motion& motion_;
  const double h_, per_h_;
};

}  // namespace weft::reference
