/// Lengths that have the same bits by every library of C++.
#pragma once

#include <algorithm>
#include <cmath>

namespace weft {

/// The length of (x, y, z), scaled by its largest part, so that no square leaves the range of
/// numbers. By this formula libstdc++ has std::hypot of three; others differ in the last digit.
inline double hypotenuse(double x, double y, double z = 0) {
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (largest == 0 || std::isinf(largest)) return largest;
  const double a = x / largest, b = y / largest, c = z / largest;
  return largest * std::sqrt(a * a + b * b + c * c);
}

}  // namespace weft
