/// The fronts of a sparse factorisation A = L D L^T (multifrontal: Duff and Reid 1983).
///
/// Columns of L with nearly the same pattern form a front, and are eliminated together as a dense
/// matrix (kernels/simd/fronts.h). The update is what a front leaves for the rows below its
/// columns. It is added to the parent, which is the front that eliminates the first of these rows.
/// The fronts thus form a tree. They are sorted so that children come before parents and every
/// subtree is contiguous.
///
/// Merging a front with its parent adds zeros to compute with and saves an update to add. Fronts
/// are merged where an estimate of the time is in favour of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/lists.h"

namespace weft {

/// A front, padded: the rows of the triangle and the rows below it to multiples of kFrontRows, the
/// columns to multiples of four.
struct DirectFront {
  std::uint32_t first = 0, count = 0;  // its columns in the matrix
  std::uint32_t width = 0;             // count, padded
  std::uint32_t triangle = 0;          // rows of the triangle, padded
  std::uint32_t below = 0;             // rows below, padded
  std::uint32_t parent = 0;            // kNoIndex at a root
  std::size_t panel = 0;               // index of its first value in L
  std::size_t column = 0;              // index of its first column among all padded columns
  std::size_t update = 0;              // index of its first value in the stack of its level
  std::uint32_t level = 0;             // parity of its depth, which selects a stack

  std::size_t stride() const { return std::size_t{triangle} + below; }
};

struct DirectFronts {
  std::vector<DirectFront> fronts;
  Lists rows;                           // per front: the rows below its columns, ascending
  Lists place;                          // per front: these rows as rows of the parent
  Lists children;                       // per front
  std::size_t values = 0, columns = 0;  // padded, in all panels
  std::size_t most_values = 0;          // in one panel
  std::size_t most_rows = 0;            // in one panel
  std::size_t stack[2] = {0, 0};        // the size of the stack of each level

  /// The index of the entry (row, column) of the lower triangle among all values.
  std::size_t place_of(std::uint32_t row, std::uint32_t column) const;
  std::size_t bytes() const;
};

/// The parent of each column in the elimination tree, kNoIndex at a root (Liu 1990). `neighbours`
/// lists, for each row, the rows with which it has an entry.
std::vector<std::uint32_t> elimination_tree(const Lists& neighbours);
/// The columns in postorder: every subtree is contiguous, and children come before parents.
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent);
/// Makes the fronts of a matrix that is in postorder.
DirectFronts make_direct_fronts(const Lists& neighbours);

}  // namespace weft
