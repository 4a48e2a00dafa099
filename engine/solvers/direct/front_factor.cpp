#include "engine/solvers/direct/front_factor.h"

#include <algorithm>
#include <cstring>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// Copies four numbers. A copy of any count is a call.
void copy_vector(const double* from, double* to) { std::memcpy(to, from, 4 * sizeof *to); }

}  // namespace

FrontFactor::FrontFactor(const DirectFronts& fronts, const simd::Table& kernels)
    : fronts_(fronts), kernels_(kernels) {
  lower_.resize(fronts.values);
  reciprocal_.resize(fronts.columns);
  least_.resize(fronts.columns);
  for (std::size_t level = 0; level < 2; ++level) updates_[level].resize(fronts.stack[level]);
  scratch_.resize(fronts.most_values);
  part_.resize(4 * fronts.most_rows);
}

simd::Front FrontFactor::front_at(std::size_t i) {
  const DirectFront& front = fronts_.fronts[i];
  return {.width = front.width,
          .stride = front.stride(),
          .below = front.below,
          .panel = lower_.data() + front.panel,
          .update = updates_[front.level].data() + front.update,
          .least = least_.data() + front.column,
          .reciprocal = reciprocal_.data() + front.column,
          .scratch = scratch_.data()};
}

void FrontFactor::clear(std::size_t i) {
  const simd::Front front = front_at(i);
  std::fill_n(front.panel, front.width * front.stride, 0.0);
  std::fill_n(front.update, front.below * front.below, 0.0);
}

void FrontFactor::eliminate(std::size_t i) {
  const simd::Front front = front_at(i);
  for (const std::uint32_t child : fronts_.children[i]) {
    add_update(fronts_.fronts[child], child, front);
  }
  kernels_.eliminate_front(front);
}

/// Adds the update of a child, column by column, to the panel or to the update of its parent.
void FrontFactor::add_update(const DirectFront& child, std::size_t number,
                             const simd::Front& parent) const {
  const auto place = fronts_.place[number];
  const std::size_t triangle = parent.stride - parent.below;
  const double* from = updates_[child.level].data() + child.update;
  for (std::size_t c = 0; c < place.size(); ++c, from += child.below) {
    const std::size_t at = place[c];
    double* const to = at < triangle ? parent.panel + at * parent.stride
                                     : parent.update + (at - triangle) * parent.below - triangle;
    for (std::size_t r = c; r < place.size(); ++r) to[place[r]] += from[r];
  }
}

void FrontFactor::solve(double* b) {
  double* const z = part_.data();
  for (std::size_t i = 0; i < fronts_.fronts.size(); ++i) {
    const DirectFront& own = fronts_.fronts[i];
    const auto rows = fronts_.rows[i];
    std::fill_n(z, own.stride(), 0.0);
    std::copy_n(b + own.first, own.count, z);
    kernels_.solve_front_forward(front_at(i), z);
    std::copy_n(z, own.count, b + own.first);
    for (std::size_t r = 0; r < rows.size(); ++r) b[rows[r]] += z[own.triangle + r];
  }
  for (std::size_t i = fronts_.fronts.size(); i-- > 0;) {
    const DirectFront& own = fronts_.fronts[i];
    const auto rows = fronts_.rows[i];
    std::fill_n(z, own.stride(), 0.0);
    std::copy_n(b + own.first, own.count, z);
    for (std::size_t r = 0; r < rows.size(); ++r) z[own.triangle + r] = b[rows[r]];
    kernels_.solve_front_backward(front_at(i), z);
    std::copy_n(z, own.count, b + own.first);
  }
}

void FrontFactor::solve_vectors(double* b) {
  const auto vectors = [&](std::size_t row) { return b + 4 * row; };
  double* const below = part_.data();
  for (std::size_t i = 0; i < fronts_.fronts.size(); ++i) {
    const DirectFront& own = fronts_.fronts[i];
    const auto rows = fronts_.rows[i];
    for (std::size_t r = 0; r < rows.size(); ++r) copy_vector(vectors(rows[r]), below + 4 * r);
    kernels_.solve_vectors_forward(front_at(i), {vectors(own.first), below}, own.count,
                                   rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) copy_vector(below + 4 * r, vectors(rows[r]));
  }
  for (std::size_t i = fronts_.fronts.size(); i-- > 0;) {
    const DirectFront& own = fronts_.fronts[i];
    const auto rows = fronts_.rows[i];
    for (std::size_t r = 0; r < rows.size(); ++r) copy_vector(vectors(rows[r]), below + 4 * r);
    kernels_.solve_vectors_backward(front_at(i), {vectors(own.first), below}, own.count,
                                    rows.size());
  }
}

std::size_t FrontFactor::bytes() const {
  return bytes_of(lower_) + bytes_of(reciprocal_) + bytes_of(least_) + bytes_of(updates_[0]) +
         bytes_of(updates_[1]) + bytes_of(scratch_) + bytes_of(part_);
}

}  // namespace weft
