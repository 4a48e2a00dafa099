/// What kernels of the linear system of bending read and write (bending_system.h): vectors in
/// double, four numbers for each slot, | x y z - |, 64-byte aligned.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weft::simd {

/// Slots whose rows are stored side by side.
inline constexpr std::size_t kBendingRows = 4;

/// The matrix A = inertia M + stiffness K, by groups of kBendingRows slots. An entry is that of
/// each row of the group; where a row has fewer it has zeros.
struct BendingMatrix {
  const std::uint32_t* begin = nullptr;   // per group: its first entry, and the end of the last
  const std::uint32_t* column = nullptr;  // per entry and row: 4 slot
  const double* value = nullptr;          // per entry and row: of K, N/m
  const double* mass = nullptr;           // per slot, kg; of what is fixed: 0
  double inertia = 0;                     // 1 / (b h)^2, 1/s^2
  double stiffness = 1;
};

/// Conjugate gradients on A x = b.
struct BendingGradients {
  double* x = nullptr;
  double* residual = nullptr;          // r = b - A x
  double* direction = nullptr;         // p
  double* product = nullptr;           // A p
  const double* reciprocal = nullptr;  // per slot: 1 over the diagonal of A; of what is fixed: 0
};

/// A front of a sparse factorisation, and three right sides at once.
struct FrontVectors {
  double* own = nullptr;    // four numbers for each column
  double* below = nullptr;  // and for each row below
};

}  // namespace weft::simd
