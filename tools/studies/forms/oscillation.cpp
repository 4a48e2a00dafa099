#include "tools/studies/forms/oscillation.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace weft::tools::forms {

Oscillation oscillation_of(std::span<const double> y, double dt) {
  double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;  // of y_(k+1) = p y_k + q y_(k-1)
  for (std::size_t k = 1; k + 1 < y.size(); ++k) {
    aa += y[k] * y[k];
    ab += y[k] * y[k - 1];
    bb += y[k - 1] * y[k - 1];
    ac += y[k] * y[k + 1];
    bc += y[k - 1] * y[k + 1];
  }
  const double size = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / size, q = (aa * bc - ab * ac) / size;
  const double rate = -std::log(-q) / (2 * dt);
  const double frequency = std::acos(p / (2 * std::sqrt(-q))) / dt;
  return {frequency, 2 * std::numbers::pi * rate / frequency};
}

}  // namespace weft::tools::forms
