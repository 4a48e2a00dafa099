#include "engine/solvers/small_steps/bending_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

constexpr std::size_t kRows = simd::kBendingRows;

/// One row after the other: all products of two weights of an element at these rows.
class RowMaker {
 public:
  RowMaker(const Model& model, BendingRows& rows)
      : model_(model), rows_(rows), place_(model.slots(), kNone) {
    const BendingStore& store = model.bending;
    elements_ = make_lists(model.slots(), [&](auto&& add) {
      for (std::uint32_t e = 0; e < store.size(); ++e) {
        for (std::size_t i = 0; i < 4; ++i) {
          if (store.weights[e][i] != 0) add(store.slots[e][i], e);
        }
      }
    });
    rows_.columns.begin.assign(1, 0);
    rows_.columns.begin.reserve(model.slots() + 1);
  }

  /// Returns what is on the diagonal.
  double add(std::uint32_t slot) {
    columns_.clear();
    sums_.clear();
    if (model_.inverse_mass[slot] > 0) {
      for (const std::uint32_t e : elements_[slot]) add_products(slot, e);
    }
    const double diagonal = place_[slot] == kNone ? 0 : sums_[place_[slot]];
    std::ranges::sort(columns_);
    for (const std::uint32_t column : columns_)
      rows_.values.push_back(sums_[std::exchange(place_[column], kNone)]);
    rows_.columns.push_back(columns_);
    return diagonal;
  }

 private:
  static constexpr std::uint32_t kNone = kNoIndex;

  void add_products(std::uint32_t slot, std::uint32_t e) {
    const auto& slots = model_.bending.slots[e];
    const auto& weights = model_.bending.weights[e];
    for (std::size_t i = 0; i < 4; ++i) {
      if (slots[i] != slot) continue;
      for (std::size_t j = 0; j < 4; ++j) {
        const double product = weights[i] * weights[j];
        if (product == 0 || model_.inverse_mass[slots[j]] == 0) continue;
        add_to(slots[j], product / model_.bending.compliance[e]);
      }
    }
  }
  void add_to(std::uint32_t column, double value) {
    if (place_[column] == kNone) {
      place_[column] = static_cast<std::uint32_t>(columns_.size());
      columns_.push_back(column);
      sums_.push_back(0);
    }
    sums_[place_[column]] += value;
  }

  const Model& model_;
  BendingRows& rows_;
  Lists elements_;                      // per slot
  std::vector<std::uint32_t> place_;    // per slot: of its sum in the present row
  std::vector<std::uint32_t> columns_;  // of the row
  std::vector<double> sums_;            // in the order in which columns came
};

/// Where a group is in the entries of its rows.
struct GroupWalk {
  const BendingRows& rows;
  std::array<std::uint32_t, kRows> at{}, end{};

  GroupWalk(const BendingRows& of, std::size_t first) : rows(of) {
    for (std::size_t row = 0; row < kRows; ++row) {
      at[row] = of.columns.begin[first + row];
      end[row] = of.columns.begin[first + row + 1];
    }
  }
  /// The column of the first row, if the next entry of this one is in the same way from its own.
  std::int32_t column_of(std::size_t row) const {
    if (at[row] == end[row]) return std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(rows.columns.items[at[row]]) - static_cast<std::int32_t>(row);
  }
  /// take(column, values of the rows) for each column of the group.
  template <class Take>
  void run(Take&& take) {
    while (true) {
      std::int32_t column = column_of(0);
      for (std::size_t row = 1; row < kRows; ++row) column = std::min(column, column_of(row));
      if (column == std::numeric_limits<std::int32_t>::max()) return;
      std::array<double, kRows> values{};
      for (std::size_t row = 0; row < kRows; ++row) {
        if (column_of(row) == column) values[row] = rows.values[at[row]++];
      }
      take(column, values);
    }
  }
};

/// Columns of a group by their way from its rows: these of a grid have one stencil.
void add_groups(BendingRows& rows) {
  rows.begin.reserve(rows.slots() / kRows + 1);
  rows.begin.push_back(0);
  for (std::uint32_t first = 0; first < rows.slots(); first += kRows) {
    GroupWalk(rows, first).run([&](std::int32_t column, const auto&) {
      rows.column.push_back(4 * column);
    });
    rows.begin.push_back(static_cast<std::uint32_t>(rows.column.size()));
  }
  rows.column.shrink_to_fit();
}

float to_bounded_float(double number) {
  return static_cast<float>(std::min<double>(number, std::numeric_limits<float>::max()));
}

/// The largest stiffness of M^-1/2 K M^-1/2 = B. For positive x no swing is stiffer than the
/// largest (|B| x)_i / x_i, which falls from the largest sum of a row as x becomes |B| x (Collatz,
/// Wielandt): one light particle has stiff rows beside it, and a swing that is not as stiff.
double largest_stiffness(const BendingRows& rows) {
  constexpr int kTimes = 16;
  std::vector<double> root(rows.slots()), x(rows.slots(), 1.0), next(rows.slots(), 1.0);
  for (std::size_t slot = 0; slot < rows.slots(); ++slot)
    root[slot] = rows.bends(slot) ? 1 / std::sqrt(rows.mass[slot]) : 0;
  double most = 0;
  for (int i = 0; i < kTimes; ++i) {
    most = 0;
    for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
      if (!rows.bends(slot)) continue;
      double sum = 0;
      for (std::uint32_t e = rows.columns.begin[slot]; e < rows.columns.begin[slot + 1]; ++e)
        sum += std::abs(rows.values[e]) * root[rows.columns.items[e]] * x[rows.columns.items[e]];
      next[slot] = root[slot] * sum;
      most = std::max(most, next[slot] / x[slot]);
    }
    for (std::size_t slot = 0; slot < rows.slots(); ++slot)
      x[slot] = std::max(next[slot] / most, std::numeric_limits<double>::min());
  }
  return most;
}

}  // namespace

template <class Real>
kernels::AlignedVector<Real> BendingRows::values_by_groups() const {
  kernels::AlignedVector<Real> by_groups;
  by_groups.reserve(kRows * column.size());
  for (std::uint32_t first = 0; first < slots(); first += kRows) {
    GroupWalk(*this, first).run([&](std::int32_t, const auto& of_rows) {
      for (const double value : of_rows) {
        if constexpr (std::is_same_v<Real, float>)
          by_groups.push_back(to_bounded_float(value));
        else
          by_groups.push_back(value);
      }
    });
  }
  return by_groups;
}
template kernels::AlignedVector<float> BendingRows::values_by_groups() const;
template kernels::AlignedVector<double> BendingRows::values_by_groups() const;

BendingRows make_bending_rows(const Model& model) {
  BendingRows rows;
  if (model.bending.size() == 0) return rows;
  rows.mass.resize(model.slots());
  rows.diagonal.resize(model.slots());
  RowMaker maker(model, rows);
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    rows.diagonal[slot] = maker.add(slot);
    if (rows.diagonal[slot] > 0) rows.mass[slot] = 1 / model.inverse_mass[slot];
  }
  rows.values.shrink_to_fit();
  rows.columns.items.shrink_to_fit();
  add_groups(rows);
  rows.floats = rows.values_by_groups<float>();
  rows.float_mass.resize(rows.slots());
  std::ranges::transform(rows.mass, rows.float_mass.begin(), to_bounded_float);
  rows.stiffest = largest_stiffness(rows);
  return rows;
}

std::size_t BendingRows::bytes() const {
  return columns.bytes() + bytes_of(values) + bytes_of(begin) + bytes_of(column) +
         bytes_of(floats) + bytes_of(mass) + bytes_of(float_mass) + bytes_of(diagonal);
}

double count_that_bend(const BendingRows& rows) {
  double count = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) count += rows.bends(slot) ? 1 : 0;
  return count;
}

double mean_stiffness(const BendingRows& rows) {
  double sum = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.bends(slot)) sum += rows.diagonal[slot] / rows.mass[slot];
  }
  return sum / std::max(1.0, count_that_bend(rows));
}

}  // namespace weft
