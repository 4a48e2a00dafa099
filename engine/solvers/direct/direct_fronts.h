/// The fronts of a sparse factorisation A = L D L^T (multifrontal: Duff and Reid 1983).
///
/// Columns of L with nearly the same pattern form a front, eliminated together as a dense matrix
/// (kernels/simd/fronts.h). What it leaves for the rows below its columns, its update, is added to
/// the front that eliminates the first of these rows, its parent. So the fronts are a tree, and
/// they stand in an order that has children before parents and every subtree in one stretch.
///
/// Merging a front with its parent makes more zeros to compute with and fewer updates to add: it is
/// done where an estimate of the time says so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/lists.h"

namespace weft {

/// Eight rows are a group: triangles and what is below them are padded to whole groups, columns to
/// fours.
struct DirectFront {
  std::uint32_t first = 0, count = 0;  // columns of the matrix
  std::uint32_t width = 0;             // count, padded
  std::uint32_t triangle = 0;          // rows of the triangle, padded
  std::uint32_t below = 0;             // rows below, padded
  std::uint32_t parent = 0;            // kNoIndex: none
  std::size_t panel = 0;               // of its first value in L
  std::size_t column = 0;              // of its first column among all padded columns
  std::size_t update = 0;              // of its first value in the stack of its level
  std::uint32_t level = 0;             // 0 or 1, the parent's being the other

  std::size_t stride() const { return std::size_t{triangle} + below; }
};

struct DirectFronts {
  std::vector<DirectFront> fronts;
  Lists rows;                           // per front: the rows below its columns, ascending
  Lists place;                          // where these stand in the parent: rows of its panel
  Lists children;                       // per front
  std::size_t values = 0, columns = 0;  // padded, of all panels
  std::size_t most_values = 0;          // of one panel
  std::size_t most_rows = 0;            // of one panel
  std::size_t stack[2] = {0, 0};        // updates waiting, at most, on even and on odd levels

  /// Of the entry (row, column) of the lower triangle: its place among all values.
  std::size_t place_of(std::uint32_t row, std::uint32_t column) const;
  std::size_t bytes() const;
};

/// The parent of each column in the tree of elimination, kNoIndex at a root (Liu 1990).
/// neighbours: per row those it has an entry with.
std::vector<std::uint32_t> elimination_tree(const Lists& neighbours);
/// The columns in an order that has every subtree in one stretch, children before parents.
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent);
/// Of a matrix that is in such an order.
DirectFronts make_direct_fronts(const Lists& neighbours);

}  // namespace weft
