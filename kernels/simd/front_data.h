/// Data of the kernels of the direct solver: fronts of a sparse factorisation.
#pragma once

#include <cstddef>

namespace weft::simd {

/// Rows of a front come in groups of so many, as in AVX-512.
inline constexpr std::size_t kFrontRows = 8;

/// A front of a sparse factorisation (fronts.h). All arrays are 64-byte aligned, the padding of
/// panel and update is 0.
struct Front {
  std::size_t width = 0;          // columns of the panel, a multiple of 4
  std::size_t stride = 0;         // rows of the panel, a multiple of kFrontRows
  std::size_t below = 0;          // the last of them; rows and columns of update
  double* panel = nullptr;        // in: assembled; out: L without its diagonal, 0 above it
  double* update = nullptr;       // in: assembled; out: what is passed on
  const double* least = nullptr;  // per column: a pivot that is no larger is taken as infinite
  double* reciprocal = nullptr;   // per column: 1 / d, or 0
  double* scratch = nullptr;      // as large as panel
};

}  // namespace weft::simd
