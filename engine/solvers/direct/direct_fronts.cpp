#include "engine/solvers/direct/direct_fronts.h"

#include <weft/weft.h>

#include <algorithm>
#include <iterator>

#include "engine/bytes_of.h"
#include "engine/tuning.h"
#include "kernels/simd/table.h"

namespace weft {
namespace {

/// A front before it is stored.
struct Draft {
  std::uint32_t first, count;
  std::vector<std::uint32_t> below;
};

double estimated_time(std::size_t count, std::size_t rows_below) {
  const auto width = static_cast<double>(kernels::round_up(count, 4));
  const auto below = static_cast<double>(kernels::round_up(rows_below, simd::kFrontRows));
  const auto passed = static_cast<double>(rows_below);
  const double panel = width * (0.5 * width + below);
  const double products = width * (width * width / 6 + 0.5 * width * below + 0.5 * below * below);
  return tuning::kFrontTime + tuning::kValueTime * (0.5 * passed * passed + 0.25 * panel) +
         tuning::kProductTime * products;
}

/// Whether a front should become part of its parent, which directly follows it.
bool is_worth_merging(const Draft& child, const Draft& parent) {
  if (child.below.empty() || child.below[0] >= parent.first + parent.count) return false;
  return estimated_time(child.count + parent.count, parent.below.size()) <=
         estimated_time(child.count, child.below.size()) +
             estimated_time(parent.count, parent.below.size());
}

void unite(std::vector<std::uint32_t>& rows, std::span<const std::uint32_t> more,
           std::uint32_t beyond, std::vector<std::uint32_t>& scratch) {
  const auto first = std::ranges::upper_bound(more, beyond);
  scratch.clear();
  std::set_union(rows.begin(), rows.end(), first, more.end(), std::back_inserter(scratch));
  rows.swap(scratch);
}

/// The pattern of each column is the union of its pattern in A and those of its children, without
/// the column itself.
std::vector<Draft> draft_fronts(const Lists& neighbours) {
  std::vector<Draft> drafts;
  std::vector<std::uint32_t> open, scratch, sorted;  // open: drafts without a parent so far
  for (std::uint32_t k = 0; k < neighbours.size(); ++k) {
    Draft front{k, 1, {}};
    sorted.assign(neighbours[k].begin(), neighbours[k].end());
    std::ranges::sort(sorted);
    unite(front.below, sorted, k, scratch);
    while (!open.empty() && drafts[open.back()].below.front() == k) {
      unite(front.below, drafts[open.back()].below, k, scratch);
      open.pop_back();
    }
    while (!drafts.empty() && is_worth_merging(drafts.back(), front)) {
      front.first = drafts.back().first;
      front.count += drafts.back().count;
      drafts.pop_back();
    }
    if (!front.below.empty()) open.push_back(static_cast<std::uint32_t>(drafts.size()));
    drafts.push_back(std::move(front));
  }
  return drafts;
}

void store_fronts(const std::vector<Draft>& drafts, DirectFronts& f) {
  for (const Draft& draft : drafts) {
    DirectFront front;
    front.first = draft.first;
    front.count = draft.count;
    front.width = static_cast<std::uint32_t>(kernels::round_up(draft.count, 4));
    front.triangle = static_cast<std::uint32_t>(kernels::round_up(draft.count, simd::kFrontRows));
    front.below =
        static_cast<std::uint32_t>(kernels::round_up(draft.below.size(), simd::kFrontRows));
    front.panel = f.values;
    front.column = f.columns;
    const std::size_t values = front.width * front.stride();
    f.values += values;
    f.columns += kernels::round_up(front.width, simd::kFrontRows);
    f.most_values = std::max(f.most_values, values);
    f.most_rows = std::max(f.most_rows, front.stride());
    f.fronts.push_back(front);
    f.rows.push_back(draft.below);
  }
}

/// The row of the panel of a front that holds this row of the matrix.
std::uint32_t row_in(const DirectFronts& f, std::uint32_t front, std::uint32_t row) {
  const DirectFront& own = f.fronts[front];
  if (row < own.first + own.count) return row - own.first;
  const auto rows = f.rows[front];
  const auto at = std::ranges::lower_bound(rows, row) - rows.begin();
  return own.triangle + static_cast<std::uint32_t>(at);
}

std::uint32_t front_of(const DirectFronts& f, std::uint32_t column) {
  const auto after = std::ranges::upper_bound(f.fronts, column, {}, &DirectFront::first);
  return static_cast<std::uint32_t>(after - f.fronts.begin() - 1);
}

void store_tree(DirectFronts& f) {
  std::vector<std::uint32_t> place;
  for (std::uint32_t i = 0; i < f.fronts.size(); ++i) {
    place.clear();
    f.fronts[i].parent = f.rows[i].empty() ? kNoIndex : front_of(f, f.rows[i][0]);
    for (const std::uint32_t row : f.rows[i]) place.push_back(row_in(f, f.fronts[i].parent, row));
    f.place.push_back(place);
  }
  f.children = make_lists(f.fronts.size(), [&](auto&& add) {
    for (std::uint32_t i = 0; i < f.fronts.size(); ++i) {
      if (f.fronts[i].parent != kNoIndex) add(f.fronts[i].parent, i);
    }
  });
}

/// Updates wait on two stacks, one for even and one for odd levels: the update of a front is pushed
/// on one while those of its children are popped from the other.
void place_updates(DirectFronts& f) {
  for (std::size_t i = f.fronts.size(); i-- > 0;) {
    DirectFront& front = f.fronts[i];
    front.level = front.parent == kNoIndex ? 0 : 1 - f.fronts[front.parent].level;
  }
  std::size_t top[2] = {0, 0};
  for (std::size_t i = 0; i < f.fronts.size(); ++i) {
    DirectFront& front = f.fronts[i];
    if (!f.children[i].empty()) top[1 - front.level] = f.fronts[f.children[i][0]].update;
    front.update = top[front.level];
    top[front.level] += std::size_t{front.below} * front.below;
    f.stack[front.level] = std::max(f.stack[front.level], top[front.level]);
  }
}

}  // namespace

std::vector<std::uint32_t> elimination_tree(const Lists& neighbours) {
  const std::size_t rows = neighbours.size();
  std::vector<std::uint32_t> parent(rows, kNoIndex), ancestor(rows, kNoIndex);
  for (std::uint32_t k = 0; k < rows; ++k) {
    for (std::uint32_t j : neighbours[k]) {
      while (j < k) {
        const std::uint32_t next = ancestor[j];
        ancestor[j] = k;
        if (next == kNoIndex) parent[j] = k;
        j = next;
      }
    }
  }
  return parent;
}

std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent) {
  const auto rows = static_cast<std::uint32_t>(parent.size());
  std::vector<std::uint32_t> first_child(rows, kNoIndex), next(rows, kNoIndex), order, stack;
  std::uint32_t root = kNoIndex;
  for (std::uint32_t k = rows; k-- > 0;) {
    std::uint32_t& head = parent[k] == kNoIndex ? root : first_child[parent[k]];
    next[k] = head;
    head = k;
  }
  const auto enter = [&](std::uint32_t k) {
    for (; k != kNoIndex; k = first_child[k]) stack.push_back(k);
  };
  enter(root);
  while (!stack.empty()) {
    const std::uint32_t k = stack.back();
    stack.pop_back();
    order.push_back(k);
    enter(next[k]);
  }
  return order;
}

DirectFronts make_direct_fronts(const Lists& neighbours) {
  DirectFronts f;
  store_fronts(draft_fronts(neighbours), f);
  store_tree(f);
  place_updates(f);
  return f;
}

std::size_t DirectFronts::place_of(std::uint32_t row, std::uint32_t column) const {
  const std::uint32_t front = front_of(*this, column);
  const DirectFront& own = fronts[front];
  return own.panel + (column - own.first) * own.stride() + row_in(*this, front, row);
}

std::size_t DirectFronts::bytes() const {
  return bytes_of(fronts) + rows.bytes() + place.bytes() + children.bytes();
}

}  // namespace weft
