/// The method by which a substep goes on from the one before.
#pragma once

#include <weft/weft.h>

#include <cmath>

#include "kernels/vectors.h"

namespace weft {

/// BDF2 with the step before, or the first-order method (kernels/simd/small_steps.h).
///
/// Where motion decays by the rate r (Damping::motion) a substep begins with v <- left v, and with
/// the same for v_before; that of the next substep is the v of this one after that. left is e^(-r
/// h). Accelerations and the impulses of constraints act for the same share of b h, so that what
/// hangs at rest is stretched and bent by its whole weight; and the share is that with which what
/// falls keeps the velocity a / r.
struct SubstepFormula {
  /// 1 + sqrt(2): a substep that is more than so many times as long as the last one starts without
  /// a past, for from there on the variable-step method is not zero-stable (Grigorieff 1983).
  static constexpr double kLargestRatio = 2.414;
  double past = 0;              // c
  double part = 1;              // b
  double slope = 0;             // r / c, of its departure (reference::departure())
  double error_share = 1. / 2;  // of h times the departure: its local error
  double left = 1;              // of velocities
  double share = 1;             // of b h, in which accelerations act
  static SubstepFormula of(Scheme scheme, double ratio) {
    if (scheme != Scheme::bdf2) return {};
    return {ratio * ratio / (1 + 2 * ratio), (1 + ratio) / (1 + 2 * ratio), 2 + 1 / ratio, 1. / 3};
  }
  SubstepFormula with_decay(double rate, double h, double h_before) const {
    if (rate == 0) return *this;
    const double lost = -std::expm1(-rate * h), lost_before = -std::expm1(-rate * h_before);
    SubstepFormula decaying = *this;
    decaying.left = 1 - lost;
    decaying.share = (lost - past * (1 - lost) * lost_before) / (rate * part * h);
    return decaying;
  }
  /// A substep begins with v + c (v - v_before), and forces act in the part b of it: a particle
  /// whose v_before becomes less by d gains the momentum c / b d, per mass.
  double share_of_past() const { return past / part; }
  /// (b h)^2 over the mass is what a constant force moves a particle by.
  double give(double h) const { return part * h * (part * h) * share; }
};

/// The past of a particle's flight that the next substep needs.
struct ParticlePast {
  kernels::Vector v{}, v_before{}, moved{};  // moved: in the last substep
  /// A free flight that leads to v, through a substep of h.
  static ParticlePast flight(kernels::Vector v, kernels::Vector gravity, double h) {
    return {v, v - h * gravity, h * v - (0.5 * h * h) * gravity};
  }
};

/// The largest component of the departures of each substep of a frame, and the error that they
/// stand for.
class Departures {
 public:
  void begin() { sum_ = count_ = 0; }
  void add(double largest, double error_share) {
    sum_ += error_share * largest;
    ++count_;
  }
  /// m/s
  double mean_error() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0;
  double count_ = 0;
};

}  // namespace weft
