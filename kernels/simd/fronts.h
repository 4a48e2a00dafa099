/// The dense operations on one front of a sparse factorisation
/// (engine/solvers/direct/direct_factor.h).
///
///   panel   the columns that are eliminated in this front, stored by columns: first their
///           triangle, then the rows below it, each padded to multiples of kFrontRows rows
///   update  what remains for the rows below after the elimination, as a lower triangle
///
///                width           (columns padded to fours; padding is 0)
///              +--------+
///      triangle|  D, L1 |
///              +--------+--------------+
///         below|   L2   |  U - L2 D L2^T
///              +--------+--------------+
///
/// Columns are eliminated four at a time. First the contribution of all columns before them is
/// subtracted, a product of matrices in tiles that stay in registers; then the four are eliminated
/// among themselves. Every entry sees the columns in ascending order, whatever the number of lanes,
/// so that the bits are the same on every instruction set that has an fma.
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr std::size_t kPerGroup = kFrontRows / kDoubles;  // SIMD vectors
constexpr bool kManyRegisters = kDoubles == kFrontRows;   // AVX-512 has 32

/// The number of columns of the update in a tile. With more registers, more products are computed
/// at once.
constexpr std::size_t kUpdateColumns = kManyRegisters ? 8 : 4;

/// A tile of SIMD vectors. Its loops are unrolled by force, since vectors that a variable index
/// selects would live in memory.
template <std::size_t kColumns, std::size_t kGroups>
struct Tile {
  static constexpr std::size_t kBatches = kGroups * kPerGroup;
  Doubles c[kColumns][kBatches];

  [[gnu::always_inline]] void load_from(const double* p, std::size_t stride) {
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kColumns; ++j) {
#pragma GCC unroll 8
      for (std::size_t i = 0; i < kBatches; ++i) {
        c[j][i] = Doubles::load_aligned(p + j * stride + i * kDoubles);
      }
    }
  }
  [[gnu::always_inline]] void store_to(double* p, std::size_t stride) const {
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kColumns; ++j) {
#pragma GCC unroll 8
      for (std::size_t i = 0; i < kBatches; ++i) {
        c[j][i].store_aligned(p + j * stride + i * kDoubles);
      }
    }
  }
  /// Adds l y^T, a sum over `columns` columns, where y are rows of -L D.
  [[gnu::always_inline]] void take(const double* l, const double* y, std::size_t stride,
                                   std::size_t columns) {
    for (std::size_t k = 0; k < columns; ++k, l += stride, y += stride) {
      Doubles rows[kBatches];
#pragma GCC unroll 8
      for (std::size_t i = 0; i < kBatches; ++i) {
        rows[i] = Doubles::load_aligned(l + i * kDoubles);
      }
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kColumns; ++j) {
        const Doubles factor(y[j]);
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kBatches; ++i) {
          c[j][i] = fused(rows[i], factor, c[j][i]);
        }
      }
    }
  }
};

/// The pivots of four columns, and what each subtracts from the later ones.
struct Corner {
  double reciprocal[4];
  double taken[4][4];  // [j][k], k < j: -L(j, k) d_k
};

/// Eliminates the diagonal block of four columns, which the columns before have reduced already.
[[gnu::always_inline]] inline Corner eliminate_corner(const double* p, std::size_t stride,
                                                      const double* least) {
  Corner s{};
  double y[4][4], l[4][4];
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
#pragma GCC unroll 4
    for (std::size_t j = k; j < 4; ++j) {
      y[j][k] = p[k * stride + j];
#pragma GCC unroll 4
      for (std::size_t i = 0; i < k; ++i) y[j][k] = fused(l[j][i], s.taken[k][i], y[j][k]);
    }
    s.reciprocal[k] = y[k][k] > least[k] ? 1 / y[k][k] : 0;
    for (std::size_t j = k; j < 4; ++j) {
      l[j][k] = y[j][k] * s.reciprocal[k];
      s.taken[j][k] = -y[j][k];
    }
  }
  return s;
}

template <std::size_t kGroups>
[[gnu::always_inline]] inline void finish(Tile<4, kGroups>& tile, const Corner& s, double* l,
                                          double* y, std::size_t stride) {
#pragma GCC unroll 8
  for (std::size_t i = 0; i < kGroups * kPerGroup; ++i) {
    Doubles done[4];
#pragma GCC unroll 4
    for (std::size_t k = 0; k < 4; ++k) {
      Doubles c = tile.c[k][i];
#pragma GCC unroll 4
      for (std::size_t m = 0; m < k; ++m) c = fused(done[m], Doubles(s.taken[k][m]), c);
      done[k] = c * Doubles(s.reciprocal[k]);
      (-c).store_aligned(y + k * stride + i * kDoubles);
      done[k].store_aligned(l + k * stride + i * kDoubles);
    }
  }
}

template <std::size_t kGroups>
[[gnu::always_inline]] inline void panel_tile(const Front& f, const Corner& s, std::size_t column,
                                              std::size_t row) {
  Tile<4, kGroups> tile;
  double* const l = f.panel + column * f.stride + row;
  tile.load_from(l, f.stride);
  tile.take(f.panel + row, f.scratch + column, f.stride, column);
  finish(tile, s, l, f.scratch + column * f.stride + row, f.stride);
}

/// Clears what the first group of rows received on and above the diagonal.
inline void clear_above(double* l, std::size_t stride, std::size_t first, std::size_t column) {
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t row = first; row <= column + k; ++row) l[k * stride + row] = 0;
  }
}

/// Eliminates the columns [column, column + 4) of the panel.
inline void eliminate_four(const Front& f, std::size_t column) {
  const std::size_t first = column / kFrontRows * kFrontRows;
  Tile<4, 1> head;
  double* const l = f.panel + column * f.stride;
  head.load_from(l + first, f.stride);
  head.take(f.panel + first, f.scratch + column, f.stride, column);
  head.store_to(l + first, f.stride);
  Corner s = eliminate_corner(l + column, f.stride, f.least + column);
  for (std::size_t k = 0; k < 4; ++k) f.reciprocal[column + k] = s.reciprocal[k];
  finish(head, s, l + first, f.scratch + column * f.stride + first, f.stride);
  clear_above(l, f.stride, first, column);
  std::size_t row = first + kFrontRows;
  if constexpr (kManyRegisters) {
    for (; row + 4 * kFrontRows < f.stride; row += 3 * kFrontRows) panel_tile<3>(f, s, column, row);
    for (; row + kFrontRows < f.stride; row += 2 * kFrontRows) panel_tile<2>(f, s, column, row);
  }
  for (; row < f.stride; row += kFrontRows) panel_tile<1>(f, s, column, row);
}

template <std::size_t kGroups>
[[gnu::always_inline]] inline void update_tile(const Front& f, std::size_t column,
                                               std::size_t row) {
  Tile<kUpdateColumns, kGroups> tile;
  double* const u = f.update + column * f.below + row;
  const std::size_t triangle = f.stride - f.below;
  tile.load_from(u, f.below);
  tile.take(f.panel + triangle + row, f.scratch + triangle + column, f.stride, f.width);
  tile.store_to(u, f.below);
}

void eliminate_front(const Front& f) {
  for (std::size_t column = 0; column < f.width; column += 4) eliminate_four(f, column);
  for (std::size_t column = 0; column < f.below; column += kUpdateColumns) {
    std::size_t row = column / kFrontRows * kFrontRows;
    if constexpr (kManyRegisters) {
      for (; row + kFrontRows < f.below; row += 2 * kFrontRows) update_tile<2>(f, column, row);
    }
    for (; row < f.below; row += kFrontRows) update_tile<1>(f, column, row);
  }
}

/// Computes z = L^-1 z for one front. z holds the unknowns of the front, and below them what they
/// subtract from later unknowns.
void solve_front_forward(const Front& f, double* z) {
  for (std::size_t column = 0; column < f.width; column += 4) {
    const double* const l = f.panel + column * f.stride;
    double x[4];
    for (std::size_t j = 0; j < 4; ++j) {
      x[j] = -z[column + j];
      for (std::size_t k = 0; k < j; ++k) {
        x[j] = fused(-l[k * f.stride + column + j], x[k], x[j]);
      }
    }
    for (std::size_t r = column / kFrontRows * kFrontRows; r < f.stride; r += kDoubles) {
      Doubles sum = load(z + r);
      for (std::size_t k = 0; k < 4; ++k) {
        sum = fused(Doubles::load_aligned(l + k * f.stride + r), Doubles(x[k]), sum);
      }
      sum.store_aligned(z + r);
    }
  }
}

/// The sum of the lanes of a group in a fixed order.
[[gnu::always_inline]] inline double sum_of(const Doubles (&sums)[kPerGroup]) {
  alignas(64) double lane[kFrontRows];
  for (std::size_t i = 0; i < kPerGroup; ++i) sums[i].store_aligned(lane + i * kDoubles);
  return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

/// Computes z = L^-T D^-1 z, where the unknowns below are known.
void solve_front_backward(const Front& f, double* z) {
  for (std::size_t column = f.width; column > 0;) {
    column -= 4;
    const double* const l = f.panel + column * f.stride;
    double x[4];
    for (std::size_t j = 0; j < 4; ++j) {
      x[j] = z[column + j] * f.reciprocal[column + j];
      z[column + j] = 0;
    }
    Doubles sums[4][kPerGroup];
    for (auto& group : sums) {
      for (Doubles& sum : group) sum = Doubles(0.);
    }
    for (std::size_t r = column / kFrontRows * kFrontRows; r < f.stride; r += kFrontRows) {
      for (std::size_t i = 0; i < kPerGroup; ++i) {
        const Doubles known = Doubles::load_aligned(z + r + i * kDoubles);
        for (std::size_t j = 0; j < 4; ++j) {
          const double* const entries = l + j * f.stride + r + i * kDoubles;
          sums[j][i] = fused(Doubles::load_aligned(entries), known, sums[j][i]);
        }
      }
    }
    for (std::size_t j = 4; j-- > 0;) {
      double sum = x[j] - sum_of(sums[j]);
      for (std::size_t k = j + 1; k < 4; ++k) {
        sum = fused(-l[j * f.stride + column + k], z[column + k], sum);
      }
      z[column + j] = sum;
    }
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
