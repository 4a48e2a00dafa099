/// What a damped oscillation is, from samples of it.
#pragma once

#include <span>

namespace weft::tools::forms {

struct Oscillation {
  double frequency = 0;  ///< rad/s
  double decrement = 0;  ///< the logarithm of two successive maxima's ratio
};

/// Of y = e^(-r t) cos(w t + phase), sampled every dt: successive samples obey
///
///     y_(k+1) = 2 e^(-r dt) cos(w dt) y_k - e^(-2 r dt) y_(k-1),
///
/// whose two factors are found by least squares.
Oscillation oscillation_of(std::span<const double> samples, double dt);

}  // namespace weft::tools::forms
