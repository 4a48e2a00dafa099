/// The original method: every iteration visits every constraint and computes its error from the
/// positions of its two ends (paper 3.2, with the formulation of 4.1).
#pragma once

#include "kernels/reference/relaxation.h"

namespace weft::reference {

template <Directions kDirections>
class OriginalLoop {
 public:
  explicit OriginalLoop(const Relaxation& r) : r_(r) {}

  void renew() {
    if constexpr (kDirections == Directions::constant) return;
    for (std::size_t c = 0; c < r_.count; ++c) renew_direction(r_, c);
  }

  Sweep sweep() {
    Sweep sweep{static_cast<std::int64_t>(r_.count), 0};
    for (std::size_t c = 0; c < r_.bilateral; ++c) sweep.corrections += visit_bilateral(c);
    for (std::size_t c = r_.bilateral; c < r_.count; ++c) sweep.corrections += visit_unilateral(c);
    return sweep;
  }

  void finish() {}

 private:
  bool visit_bilateral(std::size_t c) {
    const double change = impulse_change(r_, c, error(r_, c), 0);
    if (change == 0) return false;
    accumulate(r_, c, change);
    apply(r_, c, change);
    return true;
  }

  bool visit_unilateral(std::size_t c) {
    const double change = impulse_change(r_, c, error(r_, c), r_.impulse[c]);
    if (change == 0) return false;
    r_.impulse[c] += change;
    apply(r_, c, change);
    return true;
  }

  const Relaxation& r_;
};

}  // namespace weft::reference
