#include "engine/solvers/small_steps/linkage_layout.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <new>

#include "engine/bytes_of.h"
#include "engine/lists.h"
#include "engine/model/chains.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/constraints_of_yarns.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using Pattern = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Axes = LinkageLayout::Places::Axes;

constexpr Axes kNowhere{-1, -1, -1};

std::vector<bool> joined_slots(const Model& model) {
  std::vector<bool> joined(model.slots());
  for (const auto* ends : {&model.constraints.a, &model.constraints.b}) {
    for (const std::uint32_t slot : *ends) joined[slot] = true;
  }
  return joined;
}

/// Those that move and have a link, sorted for little fill-in of the factor by approximate minimum
/// degree: in a tree from the leaves on.
std::vector<std::uint32_t> slots_in_order(const Model& model) {
  const std::vector<bool> joined = joined_slots(model);
  std::vector<std::uint32_t> slots;
  std::vector<int> number(model.slots(), -1);
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (!joined[slot] || model.inverse_mass[slot] == 0) continue;
    number[slot] = static_cast<int>(slots.size());
    slots.push_back(slot);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < static_cast<int>(slots.size()); ++i) entries.emplace_back(i, i, 1.0);
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    const int a = number[model.constraints.a[c]], b = number[model.constraints.b[c]];
    if (a < 0 || b < 0) continue;
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Pattern pattern(static_cast<int>(slots.size()), static_cast<int>(slots.size()));
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<std::uint32_t> sorted;
  for (const int i : order.indices()) sorted.push_back(slots[static_cast<std::size_t>(i)]);
  return sorted;
}

/// A link's pivot is negative behind a particle of it, and 0 before both.
void number_unknowns(const Model& model, LinkageLayout& layout) {
  const ConstraintStore& s = model.constraints;
  const Lists links_at = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t c = 0; c < s.size(); ++c) {
      add(s.a[c], c);
      add(s.b[c], c);
    }
  });
  layout.row_of_slot.assign(model.slots(), -1);
  layout.row_of_link.assign(s.size(), -1);
  int next = 0;
  for (const std::uint32_t slot : layout.slots) {
    layout.row_of_slot[slot] = next;
    next += 3;
    for (const std::uint32_t c : links_at[slot]) {
      if (layout.row_of_link[c] < 0) layout.row_of_link[c] = next++;
    }
  }
}

/// Work on entries (row, column) of the upper triangle.
template <class Visit>
void for_each_entry(const Model& model, const LinkageLayout& layout, Visit&& visit) {
  const auto add = [&](int a, int b) { visit(std::min(a, b), std::max(a, b)); };
  for (const std::uint32_t slot : layout.slots) {
    for (int axis = 0; axis < 3; ++axis)
      add(layout.row_of_slot[slot] + axis, layout.row_of_slot[slot] + axis);
  }
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    const int a = layout.row_of_slot[model.constraints.a[c]],
              b = layout.row_of_slot[model.constraints.b[c]], own = layout.row_of_link[c];
    add(own, own);
    for (int axis = 0; axis < 3; ++axis) {
      if (a >= 0 && b >= 0) add(a + axis, b + axis);
      if (a >= 0) add(a + axis, own);
      if (b >= 0) add(b + axis, own);
    }
  }
}

void find_places(const Model& model, const Pattern& pattern, LinkageLayout& layout) {
  const auto place = [&](int a, int b) {
    const int row = std::min(a, b), column = std::max(a, b);
    const int* first = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column];
    const int* last = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(first, last, row) - pattern.innerIndexPtr());
  };
  const auto axes = [&](int a, int step_a, int b, int step_b) {
    Axes out = kNowhere;
    for (int axis = 0; axis < 3 && a >= 0 && b >= 0; ++axis)
      out[static_cast<std::size_t>(axis)] = place(a + axis * step_a, b + axis * step_b);
    return out;
  };
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    const int a = layout.row_of_slot[model.constraints.a[c]],
              b = layout.row_of_slot[model.constraints.b[c]], own = layout.row_of_link[c];
    layout.places.push_back({.of_a = axes(a, 1, a, 1),
                             .of_b = axes(b, 1, b, 1),
                             .between = axes(a, 1, b, 1),
                             .with_a = axes(a, 1, own, 0),
                             .with_b = axes(b, 1, own, 0),
                             .own = place(own, own)});
  }
  for (const std::uint32_t slot : layout.slots) {
    const int row = layout.row_of_slot[slot];
    layout.places_of_slot.push_back(axes(row, 1, row, 1));
  }
}

/// Many long chains of bars are solved side by side in lanes, where nothing heavy hangs on them.
bool are_yarns_enough(const Model& model) {
  return model.constraints.plain == model.constraints.size() &&
         model.uneven.ratio <= tuning::kNearlyEqualMasses && !constraints_of_yarns(model).empty();
}

}  // namespace

bool is_linkage(const Model& model) {
  const ConstraintStore& s = model.constraints;
  if (s.size() == 0 || s.has_springs() || is_held_twice(model) || !closes_few_loops(model))
    return false;
  return !s.strength.empty() || !are_yarns_enough(model);
}

LinkageLayout make_linkage_layout(const Model& model) {
  LinkageLayout layout;
  if (!is_linkage(model)) return layout;
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 16;
  if (model.constraints.size() > kMost) throw std::bad_alloc();
  layout.slots = slots_in_order(model);
  number_unknowns(model, layout);
  const auto size = static_cast<int>(3 * layout.slots.size() + model.constraints.size());
  std::vector<Eigen::Triplet<double>> entries;
  for_each_entry(model, layout,
                 [&](int row, int column) { entries.emplace_back(row, column, 1.0); });
  Pattern pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  pattern.makeCompressed();
  layout.matrix.column_begin.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + size + 1);
  layout.matrix.rows.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  layout.factor = find_factor_pattern(layout.matrix);
  find_places(model, pattern, layout);
  return layout;
}

std::size_t LinkageLayout::bytes() const {
  return bytes_of(slots) + bytes_of(row_of_slot) + bytes_of(row_of_link) +
         bytes_of(matrix.column_begin) + bytes_of(matrix.rows) + factor.bytes() + bytes_of(places) +
         bytes_of(places_of_slot);
}

}  // namespace weft
