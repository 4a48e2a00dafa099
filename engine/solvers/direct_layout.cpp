#include "engine/solvers/direct_layout.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/model.h"

namespace weft {
namespace {

void find_bodies(const Model& model, DirectLayout& layout) {
  const ConstraintStore& s = model.constraints;
  std::vector<std::uint32_t> degree(model.slots());
  for (std::size_t c = 0; c < s.size(); ++c) {
    ++degree[s.a[c]];
    ++degree[s.b[c]];
  }
  for (const std::uint32_t sphere : model.spheres) degree[sphere] = kNoIndex;
  layout.body_of.assign(model.slots(), kNoIndex);
  for (std::uint32_t p = 0; p < model.slots(); ++p) {
    if (degree[p] <= DirectLayout::kBodyDegree || model.inverse_mass[p] == 0) continue;
    layout.body_of[p] = static_cast<std::uint32_t>(layout.bodies.size());
    layout.bodies.push_back(p);
  }
}

/// The inverse mass of a particle inside the matrix.
double weight(const Model& model, const DirectLayout& layout, std::uint32_t p) {
  return layout.body_of[p] == kNoIndex ? model.inverse_mass[p] : 0;
}

/// Calls visit(p, j) for every pair of constraints (k, j) that share the particle p.
template <class Visit>
void for_each_neighbour(const Model& model, const DirectLayout& layout, const Lists& at,
                        std::uint32_t k, Visit&& visit) {
  const ConstraintStore& s = model.constraints;
  for (const std::uint32_t p : {s.a[k], s.b[k]}) {
    if (weight(model, layout, p) == 0) continue;
    for (const std::uint32_t j : at[p]) {
      if (j != k) visit(p, j);
    }
  }
}

/// item(i) of each of two ends: a list of i for every slot.
template <class Ends>
Lists lists_at_ends(std::size_t slots, std::span<const std::uint32_t> items, Ends&& ends) {
  Lists lists;
  lists.begin.assign(slots + 1, 0);
  for (const std::uint32_t i : items) {
    for (const std::uint32_t p : ends(i)) ++lists.begin[p + 1];
  }
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.items.resize(lists.begin.back());
  std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (const std::uint32_t i : items) {
    for (const std::uint32_t p : ends(i)) lists.items[next[p]++] = i;
  }
  return lists;
}

/// Constraints in the order in which eliminating them fills least (approximate minimum degree).
std::vector<std::uint32_t> elimination_order(const Model& model, const DirectLayout& layout,
                                             const Lists& at,
                                             std::span<const std::uint32_t> members) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  std::vector<int> number(model.constraints.size(), -1);
  for (std::size_t i = 0; i < members.size(); ++i) number[members[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double, int>> entries;
  for (const std::uint32_t k : members) {
    entries.emplace_back(number[k], number[k], 1.0);
    for_each_neighbour(model, layout, at, k, [&](std::uint32_t, std::uint32_t j) {
      entries.emplace_back(number[k], number[j], 1.0);
    });
  }
  const auto size = static_cast<int>(members.size());
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(matrix, permutation);
  std::vector<std::uint32_t> order;
  for (int i = 0; i < size; ++i) {
    order.push_back(members[static_cast<std::size_t>(permutation.indices()[i])]);
  }
  return order;
}

void store_rows(const Model& model, DirectLayout& layout) {
  const ConstraintStore& s = model.constraints;
  layout.row_of.assign(s.size(), kNoIndex);
  for (const std::uint32_t c : layout.row_constraint) {
    layout.row_of[c] = static_cast<std::uint32_t>(layout.a.size());
    layout.a.push_back(s.a[c]);
    layout.b.push_back(s.b[c]);
    layout.diagonal.push_back(weight(model, layout, s.a[c]) + weight(model, layout, s.b[c]));
  }
}

void store_entries(const Model& model, const Lists& at, DirectLayout& layout) {
  const ConstraintStore& s = model.constraints;
  layout.entry_begin.push_back(0);
  for (std::uint32_t k = 0; k < layout.rows(); ++k) {
    const std::uint32_t c = layout.row_constraint[k];
    for_each_neighbour(model, layout, at, c, [&](std::uint32_t p, std::uint32_t j) {
      if (layout.row_of[j] > k) return;
      const double w = model.inverse_mass[p];
      layout.entry_row.push_back(layout.row_of[j]);
      layout.entry_slot.push_back(p);
      layout.entry_weight.push_back((s.a[j] == p) == (s.a[c] == p) ? w : -w);
    });
    layout.entry_begin.push_back(layout.entry_row.size());
  }
}

/// Row k of L has an entry in column j where A has one, and on the path from there to the root in
/// the tree of elimination, up to k (Liu 1990).
void store_pattern(DirectLayout& layout) {
  const std::size_t rows = layout.rows();
  std::vector<std::uint32_t> parent(rows, kNoIndex), seen(rows, kNoIndex);
  layout.pattern_begin.push_back(0);
  for (std::uint32_t k = 0; k < rows; ++k) {
    seen[k] = k;
    for (std::size_t e = layout.entry_begin[k]; e < layout.entry_begin[k + 1]; ++e) {
      for (std::uint32_t j = layout.entry_row[e]; seen[j] != k; j = parent[j]) {
        seen[j] = k;
        layout.pattern_column.push_back(j);
        if (parent[j] == kNoIndex) parent[j] = k;
      }
    }
    std::sort(
        layout.pattern_column.begin() + static_cast<std::ptrdiff_t>(layout.pattern_begin.back()),
        layout.pattern_column.end());
    layout.pattern_begin.push_back(layout.pattern_column.size());
  }
}

void store_columns(DirectLayout& layout) {
  auto& begin = layout.column_begin;
  begin.assign(layout.rows() + 1, 0);
  for (const std::uint32_t j : layout.pattern_column) ++begin[j + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  layout.column_row.resize(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t k = 0; k < layout.rows(); ++k) {
    for (std::size_t i = layout.pattern_begin[k]; i < layout.pattern_begin[k + 1]; ++i) {
      layout.column_row[next[layout.pattern_column[i]]++] = k;
    }
  }
}

}  // namespace

DirectLayout make_direct_layout(const Model& model) {
  const ConstraintStore& s = model.constraints;
  DirectLayout layout;
  find_bodies(model, layout);
  std::vector<std::uint32_t> members;
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    const bool inside = weight(model, layout, s.a[c]) + weight(model, layout, s.b[c]) > 0;
    (inside ? members : layout.links).push_back(c);
  }
  const auto ends = [&](std::uint32_t c) { return std::array{s.a[c], s.b[c]}; };
  const Lists at = lists_at_ends(model.slots(), members, ends);
  layout.row_constraint = elimination_order(model, layout, at, members);
  store_rows(model, layout);
  store_entries(model, at, layout);
  store_pattern(layout);
  store_columns(layout);
  std::vector<std::uint32_t> rows(layout.rows());
  std::iota(rows.begin(), rows.end(), 0u);
  layout.rows_at = lists_at_ends(model.slots(), rows, [&](std::uint32_t r) {
    return std::array{layout.a[r], layout.b[r]};
  });
  return layout;
}

std::size_t DirectLayout::bytes() const {
  return bytes_of(row_constraint) + bytes_of(a) + bytes_of(b) + bytes_of(diagonal) +
         bytes_of(entry_begin) + bytes_of(entry_row) + bytes_of(entry_slot) +
         bytes_of(entry_weight) + bytes_of(pattern_begin) + bytes_of(pattern_column) +
         bytes_of(column_begin) + bytes_of(column_row) + bytes_of(row_of) + rows_at.bytes() +
         bytes_of(links) + bytes_of(bodies) + bytes_of(body_of);
}

}  // namespace weft
