#include "engine/mesh/moments.h"

#include <cmath>

namespace weft::mesh {
namespace {

/// A symmetric matrix becomes the factor L of L L^T, in its lower half.
void factorise(MomentMatrix& a) {
  for (std::size_t j = 0; j < kMoments; ++j) {
    for (std::size_t i = j; i < kMoments; ++i) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  }
}

Moments solve(const MomentMatrix& factor, Moments x) {
  for (std::size_t i = 0; i < kMoments; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
    x[i] /= factor[i][i];
  }
  for (std::size_t i = kMoments; i-- > 0;) {
    for (std::size_t k = i + 1; k < kMoments; ++k) x[i] -= factor[k][i] * x[k];
    x[i] /= factor[i][i];
  }
  return x;
}

}  // namespace

Moments least_squares(const MomentMatrix& b, const Moments& target, const Moments& nearest,
                      double share) {
  MomentMatrix normal{};
  Moments right{};
  for (std::size_t i = 0; i < kMoments; ++i) {
    for (std::size_t j = 0; j < kMoments; ++j) {
      for (std::size_t k = 0; k < kMoments; ++k) normal[i][j] += b[k][i] * b[k][j];
      right[i] += b[j][i] * target[j];
    }
    normal[i][i] += share;
    right[i] += share * nearest[i];
  }
  factorise(normal);
  return solve(normal, right);
}

}  // namespace weft::mesh
