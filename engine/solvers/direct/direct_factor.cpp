#include "engine/solvers/direct/direct_factor.h"

#include <algorithm>

#include "engine/bytes_of.h"

namespace weft {

DirectFactor::DirectFactor(const DirectLayout& layout, const simd::Table& kernels)
    : layout_(layout), kernels_(kernels) {
  const DirectFronts& fronts = layout.fronts;
  lower_.resize(fronts.values);
  reciprocal_.resize(fronts.columns);
  least_.resize(fronts.columns);
  for (const DirectFront& front : fronts.fronts) {
    for (std::size_t c = 0; c < front.count; ++c) {
      least_[front.column + c] = kLeastPivot * layout.diagonal[front.first + c];
    }
  }
  for (std::size_t level = 0; level < 2; ++level) updates_[level].resize(fronts.stack[level]);
  scratch_.resize(fronts.most_values);
  part_.resize(fronts.most_rows);
}

simd::Front DirectFactor::front_at(std::size_t i) {
  const DirectFront& front = layout_.fronts.fronts[i];
  return {.width = front.width,
          .stride = front.stride(),
          .below = front.below,
          .panel = lower_.data() + front.panel,
          .update = updates_[front.level].data() + front.update,
          .least = least_.data() + front.column,
          .reciprocal = reciprocal_.data() + front.column,
          .scratch = scratch_.data()};
}

void DirectFactor::clear(std::size_t i) {
  const simd::Front front = front_at(i);
  std::fill_n(front.panel, front.width * front.stride, 0.0);
  std::fill_n(front.update, front.below * front.below, 0.0);
}

void DirectFactor::eliminate(std::size_t i) {
  const simd::Front front = front_at(i);
  for (const std::uint32_t child : layout_.fronts.children[i]) {
    add_update(layout_.fronts.fronts[child], child, front);
  }
  kernels_.eliminate_front(front);
}

/// Adds the update of a child, column by column, to the panel or to the update of its parent.
void DirectFactor::add_update(const DirectFront& child, std::size_t number,
                              const simd::Front& parent) const {
  const auto place = layout_.fronts.place[number];
  const std::size_t triangle = parent.stride - parent.below;
  const double* from = updates_[child.level].data() + child.update;
  for (std::size_t c = 0; c < place.size(); ++c, from += child.below) {
    const std::size_t at = place[c];
    double* const to = at < triangle ? parent.panel + at * parent.stride
                                     : parent.update + (at - triangle) * parent.below - triangle;
    for (std::size_t r = c; r < place.size(); ++r) to[place[r]] += from[r];
  }
}

void DirectFactor::solve(double* b) {
  const DirectFronts& fronts = layout_.fronts;
  double* const z = part_.data();
  for (std::size_t i = 0; i < fronts.fronts.size(); ++i) {
    const DirectFront& own = fronts.fronts[i];
    const auto rows = fronts.rows[i];
    std::fill_n(z, own.stride(), 0.0);
    std::copy_n(b + own.first, own.count, z);
    kernels_.solve_front_forward(front_at(i), z);
    std::copy_n(z, own.count, b + own.first);
    for (std::size_t r = 0; r < rows.size(); ++r) b[rows[r]] += z[own.triangle + r];
  }
  for (std::size_t i = fronts.fronts.size(); i-- > 0;) {
    const DirectFront& own = fronts.fronts[i];
    const auto rows = fronts.rows[i];
    std::fill_n(z, own.stride(), 0.0);
    std::copy_n(b + own.first, own.count, z);
    for (std::size_t r = 0; r < rows.size(); ++r) z[own.triangle + r] = b[rows[r]];
    kernels_.solve_front_backward(front_at(i), z);
    std::copy_n(z, own.count, b + own.first);
  }
}

std::size_t DirectFactor::bytes() const {
  return bytes_of(lower_) + bytes_of(reciprocal_) + bytes_of(least_) + bytes_of(updates_[0]) +
         bytes_of(updates_[1]) + bytes_of(scratch_) + bytes_of(part_);
}

}  // namespace weft
