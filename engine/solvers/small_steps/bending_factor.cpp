#include "engine/solvers/small_steps/bending_factor.h"

#include <algorithm>
#include <cstring>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/direct/elimination_order.h"
#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {
namespace {

/// The neighbours of free slots, by their numbers among these.
Lists neighbours_of(const BendingRows& rows, const std::vector<std::uint32_t>& slots) {
  std::vector<std::uint32_t> number(rows.slots()), list;
  for (std::uint32_t i = 0; i < slots.size(); ++i) number[slots[i]] = i;
  Lists neighbours;
  neighbours.begin.push_back(0);
  for (const std::uint32_t slot : slots) {
    list.clear();
    for (const std::uint32_t column : rows.columns[slot]) {
      if (column != slot) list.push_back(number[column]);
    }
    neighbours.push_back(list);
  }
  return neighbours;
}

}  // namespace

/// A particle of no element has a row of its own: its mass.
BendingFronts make_bending_fronts(const BendingRows& rows) {
  BendingFronts layout;
  std::vector<std::uint32_t> free;
  for (std::uint32_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.bends(slot)) free.push_back(slot);
  }
  const Lists neighbours = neighbours_of(rows, free);
  const std::vector<std::uint32_t> order = elimination_order(neighbours);
  layout.fronts = make_direct_fronts(in_order(neighbours, order));
  std::vector<std::uint32_t> row_of(rows.slots());
  for (const std::uint32_t i : order) {
    row_of[free[i]] = static_cast<std::uint32_t>(layout.slots.size());
    layout.slots.push_back(free[i]);
  }
  for (const DirectFront& front : layout.fronts.fronts) {
    layout.entry_begin.push_back(layout.entry_place.size());
    for (std::uint32_t j = front.first; j < front.first + front.count; ++j) {
      const std::uint32_t slot = layout.slots[j];
      for (std::uint32_t e = rows.columns.begin[slot]; e < rows.columns.begin[slot + 1]; ++e) {
        const std::uint32_t k = row_of[rows.columns.items[e]];
        if (k < j) continue;
        layout.entry_place.push_back(layout.fronts.place_of(k, j));
        layout.entry_value.push_back(e);
      }
    }
  }
  layout.entry_begin.push_back(layout.entry_place.size());
  return layout;
}

const BendingFronts& Model::bending_fronts() const {
  return bending_fronts_.get([this] { return make_bending_fronts(small_steps().bending.rows); });
}

BendingFactor::BendingFactor(const BendingRows& rows, const BendingFronts& fronts,
                             const simd::Table& kernels)
    : rows_(rows),
      fronts_(fronts),
      factor_(fronts.fronts, kernels),
      right_(4 * fronts.slots.size()) {}

void BendingFactor::factorise(const BendingLaw& law) {
  for (std::size_t i = 0; i < fronts_.fronts.fronts.size(); ++i) {
    const DirectFront& front = fronts_.fronts.fronts[i];
    factor_.clear(i);
    for (std::size_t e = fronts_.entry_begin[i]; e < fronts_.entry_begin[i + 1]; ++e)
      factor_.at(fronts_.entry_place[e]) = law.stiffness * rows_.values[fronts_.entry_value[e]];
    for (std::size_t c = 0; c < front.count; ++c) {
      factor_.at(front.panel + c * (front.stride() + 1)) +=
          law.inertia * rows_.mass[fronts_.slots[front.first + c]];
    }
    factor_.eliminate(i);
  }
}

void BendingFactor::solve(const double* r, double* z) {
  for (std::size_t i = 0; i < fronts_.slots.size(); ++i)
    std::memcpy(right_.data() + 4 * i, r + 4 * std::size_t{fronts_.slots[i]}, 4 * sizeof *r);
  factor_.solve_vectors(right_.data());
  for (std::size_t i = 0; i < fronts_.slots.size(); ++i)
    std::memcpy(z + 4 * std::size_t{fronts_.slots[i]}, right_.data() + 4 * i, 4 * sizeof *z);
}

std::size_t BendingFronts::bytes() const {
  return bytes_of(slots) + bytes_of(entry_begin) + bytes_of(entry_place) + bytes_of(entry_value) +
         fronts.bytes();
}

std::size_t BendingFactor::bytes() const { return factor_.bytes() + bytes_of(right_); }

}  // namespace weft
