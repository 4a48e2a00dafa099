/// Data of the kernels of the linear system of bending (bending_system.h): vectors of four numbers
/// for each slot, | x y z - |, 64-byte aligned, in float or in double.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weft::simd {

/// Slots whose rows are stored side by side.
inline constexpr std::size_t kBendingRows = 2;

/// The matrix A = inertia M + stiffness K, by groups of kBendingRows slots. An entry has one column
/// for each row of the group, and these stand side by side as the rows do: rows of a grid are one
/// stencil. A row that has nothing in such a column has a zero there. So a product may read the
/// vector before the first slot and the one after the last, where it needs finite numbers.
template <class Real>
struct BendingMatrix {
  const std::uint32_t* begin = nullptr;  // per group: its first entry, and the end of the last
  const std::int32_t* column = nullptr;  // per entry, of the first row: 4 slot
  const Real* value = nullptr;           // per entry and row: of K, N/m
  const Real* mass = nullptr;            // per slot, kg; of what is fixed: 0
  Real inertia = 0;                      // 1/s^2
  Real stiffness = 1;
};

/// Conjugate gradients on A (guess + change) = b.
template <class Real>
struct BendingGradients {
  Real* residual = nullptr;          // r; in the beginning b - stiffness K guess
  Real* direction = nullptr;         // p
  Real* product = nullptr;           // A p
  Real* change = nullptr;            // of the guess; in the beginning unwritten
  const Real* guess = nullptr;       // of what is fixed: 0
  const Real* reciprocal = nullptr;  // per slot: 1 over the diagonal of A; of what is fixed: 0
};

/// In the norm of 1 / diagonal: what is left, and the force that the guess stands for.
struct BendingNorms {
  double left = 0, force = 0;
};

/// A front of a sparse factorisation, and three right sides at once.
struct FrontVectors {
  double* own = nullptr;    // four numbers for each column
  double* below = nullptr;  // and for each row below
};

}  // namespace weft::simd
