#include "engine/solvers/direct/direct_layout.h"

#include <limits>
#include <new>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/direct/elimination_order.h"
#include "engine/tuning.h"

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
    if (degree[p] <= tuning::kBodyDegree || model.inverse_mass[p] == 0) continue;
    layout.body_of[p] = static_cast<std::uint32_t>(layout.bodies.size());
    layout.bodies.push_back(p);
  }
}

/// The inverse mass of a particle in the matrix, where that of a body is 0.
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

/// The pattern of the matrix: for each member the numbers of those with which it has an entry. More
/// entries than Eigen can count would need tens of gigabytes, and are treated as a lack of memory.
Lists neighbours_of(const Model& model, const DirectLayout& layout, const Lists& at,
                    std::span<const std::uint32_t> members) {
  std::vector<std::uint32_t> number(model.constraints.size(), kNoIndex), list;
  for (std::uint32_t i = 0; i < members.size(); ++i) number[members[i]] = i;
  Lists neighbours;
  neighbours.begin.push_back(0);
  constexpr std::size_t kMostEntries = std::numeric_limits<int>::max();
  for (const std::uint32_t k : members) {
    list.clear();
    for_each_neighbour(model, layout, at, k,
                       [&](std::uint32_t, std::uint32_t j) { list.push_back(number[j]); });
    neighbours.push_back(list);
    if (neighbours.items.size() + members.size() > kMostEntries) throw std::bad_alloc();
  }
  return neighbours;
}

std::vector<std::uint32_t> order_of_members(const Model& model, const DirectLayout& layout,
                                            const Lists& at,
                                            std::span<const std::uint32_t> members) {
  std::vector<std::uint32_t> order;
  for (const std::uint32_t i : elimination_order(neighbours_of(model, layout, at, members)))
    order.push_back(members[i]);
  return order;
}

/// The diagonal of a constraint at a body is raised by tuning::kBodyCompliance. In a straight
/// string from a fixed particle to a body, the other links imply the last one as long as the body
/// does not move, and its pivot is 0. The raised diagonal, which is the compliance of a very stiff
/// spring, keeps it in the system, and the body, whose mass is in the balance of impulses, pulls at
/// it.
void store_rows(const Model& model, DirectLayout& layout) {
  const ConstraintStore& s = model.constraints;
  for (const std::uint32_t c : layout.row_constraint) {
    layout.a.push_back(s.a[c]);
    layout.b.push_back(s.b[c]);
    const double own = weight(model, layout, s.a[c]) + weight(model, layout, s.b[c]);
    const bool at_body = layout.body_of[s.a[c]] != kNoIndex || layout.body_of[s.b[c]] != kNoIndex;
    layout.diagonal.push_back(at_body ? (1 + tuning::kBodyCompliance) * own : own);
  }
}

/// Stores the entries by columns, since the columns of a front are contiguous.
void store_entries(const Model& model, const Lists& at, DirectLayout& layout) {
  const ConstraintStore& s = model.constraints;
  std::vector<std::uint32_t> row_of(s.size(), kNoIndex);  // links between bodies have none
  for (std::uint32_t row = 0; row < layout.rows(); ++row) row_of[layout.row_constraint[row]] = row;
  for (const DirectFront& front : layout.fronts.fronts) {
    layout.entry_begin.push_back(layout.entry_row.size());
    for (std::uint32_t j = front.first; j < front.first + front.count; ++j) {
      const std::uint32_t c = layout.row_constraint[j];
      for_each_neighbour(model, layout, at, c, [&](std::uint32_t p, std::uint32_t other) {
        const std::uint32_t k = row_of[other];
        if (k < j) return;
        const double w = model.inverse_mass[p];
        layout.entry_row.push_back(k);
        layout.entry_with.push_back(j);
        layout.entry_slot.push_back(p);
        layout.entry_weight.push_back((s.a[other] == p) == (s.a[c] == p) ? w : -w);
        layout.entry_place.push_back(layout.fronts.place_of(k, j));
      });
    }
  }
  layout.entry_begin.push_back(layout.entry_row.size());
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
  const Lists at = make_lists(model.slots(), [&](auto&& add) {
    for (const std::uint32_t c : members) {
      add(s.a[c], c);
      add(s.b[c], c);
    }
  });
  layout.row_constraint = order_of_members(model, layout, at, members);
  store_rows(model, layout);
  layout.fronts = make_direct_fronts(neighbours_of(model, layout, at, layout.row_constraint));
  store_entries(model, at, layout);
  layout.rows_at = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t row = 0; row < layout.rows(); ++row) {
      add(layout.a[row], row);
      add(layout.b[row], row);
    }
  });
  return layout;
}

std::size_t DirectLayout::bytes() const {
  return bytes_of(row_constraint) + bytes_of(a) + bytes_of(b) + bytes_of(diagonal) +
         bytes_of(entry_begin) + bytes_of(entry_row) + bytes_of(entry_with) + bytes_of(entry_slot) +
         bytes_of(entry_weight) + bytes_of(entry_place) + fronts.bytes() + rows_at.bytes() +
         bytes_of(links) + bytes_of(bodies) + bytes_of(body_of);
}

const DirectLayout& Model::direct() const {
  return direct_.get([this] { return make_direct_layout(*this); });
}

}  // namespace weft
