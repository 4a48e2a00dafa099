/// Functions of a direction in a plane that are polynomials of fourth degree in its sine and
/// cosine.
#pragma once

#include <array>
#include <cstddef>

namespace weft::mesh {

/// m[0] + m[1] cos 2a + m[2] sin 2a + m[3] cos 4a + m[4] sin 4a, of the angle a.
inline constexpr std::size_t kMoments = 5;
using Moments = std::array<double, kMoments>;
using MomentMatrix = std::array<Moments, kMoments>;

/// Moments of (u^T M u)^2, with the unit vector u at the angle a: u^T M u is mean + c cos 2a + s
/// sin 2a.
inline Moments moments_of_square(double mean, double c, double s) {
  return {mean * mean + (c * c + s * s) / 2, 2 * mean * c, 2 * mean * s, (c * c - s * s) / 2,
          c * s};
}

/// From axes in which angles are a to others in which they are a + turn, or turn - a if the two
/// are mirror images.
struct Turn {
  double cos2 = 1, sin2 = 0;  ///< of twice the turn
  bool mirrored = false;

  Moments operator()(const Moments& m) const {
    const double cos4 = cos2 * cos2 - sin2 * sin2, sin4 = 2 * sin2 * cos2;
    const double s2 = mirrored ? -m[2] : m[2], s4 = mirrored ? -m[4] : m[4];
    return {m[0], m[1] * cos2 - s2 * sin2, m[1] * sin2 + s2 * cos2, m[3] * cos4 - s4 * sin4,
            m[3] * sin4 + s4 * cos4};
  }

  /// Turns a matrix whose rows and columns are moments.
  MomentMatrix operator()(const MomentMatrix& matrix) const {
    MomentMatrix rows;
    for (std::size_t i = 0; i < kMoments; ++i) rows[i] = (*this)(matrix[i]);
    MomentMatrix turned;
    for (std::size_t j = 0; j < kMoments; ++j) {
      const Moments column =
          (*this)(Moments{rows[0][j], rows[1][j], rows[2][j], rows[3][j], rows[4][j]});
      for (std::size_t i = 0; i < kMoments; ++i) turned[i][j] = column[i];
    }
    return turned;
  }
};

inline double dot(const Moments& a, const Moments& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kMoments; ++i) sum += a[i] * b[i];
  return sum;
}

/// The p for which |B p - target|^2 + share |p - nearest|^2 is least.
Moments least_squares(const MomentMatrix& b, const Moments& target, const Moments& nearest,
                      double share);

}  // namespace weft::mesh
