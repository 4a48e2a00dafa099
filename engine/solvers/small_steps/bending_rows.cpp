#include "engine/solvers/small_steps/bending_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

constexpr std::size_t kRows = simd::kBendingRows;

/// work(row, column, value) for each product of two weights of an element; free particles only.
template <class Work>
void for_each_product(const Model& model, Work&& work) {
  const BendingStore& store = model.bending;
  for (std::size_t e = 0; e < store.size(); ++e) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const std::uint32_t row = store.slots[e][i], column = store.slots[e][j];
        const double product = store.weights[e][i] * store.weights[e][j];
        if (product == 0 || model.inverse_mass[row] == 0 || model.inverse_mass[column] == 0)
          continue;
        work(row, column, product / store.compliance[e]);
      }
    }
  }
}

void add_sorted(std::vector<std::pair<std::uint32_t, double>>& row, BendingRows& rows) {
  std::ranges::stable_sort(row, {}, &std::pair<std::uint32_t, double>::first);
  std::vector<std::uint32_t> columns;
  for (const auto& [column, value] : row) {
    if (columns.empty() || columns.back() != column) {
      columns.push_back(column);
      rows.values.push_back(0);
    }
    rows.values.back() += value;
  }
  rows.columns.push_back(columns);
}

/// Columns of a group by their way from its rows: these of a grid have one stencil.
void add_groups(BendingRows& rows) {
  std::map<std::int32_t, std::array<double, kRows>> entries;
  rows.begin.push_back(0);
  for (std::uint32_t first = 0; first < rows.slots(); first += kRows) {
    entries.clear();
    for (std::uint32_t row = 0; row < kRows; ++row) {
      const std::uint32_t slot = first + row;
      for (std::uint32_t e = rows.columns.begin[slot]; e < rows.columns.begin[slot + 1]; ++e) {
        const auto column = static_cast<std::int32_t>(rows.columns.items[e]);
        entries[column - static_cast<std::int32_t>(row)][row] = rows.values[e];
      }
    }
    for (const auto& [column, values] : entries) {
      rows.column.push_back(4 * column);
      rows.doubles.value.insert(rows.doubles.value.end(), values.begin(), values.end());
    }
    rows.begin.push_back(static_cast<std::uint32_t>(rows.column.size()));
  }
}

void narrow(const kernels::AlignedVector<double>& from, kernels::AlignedVector<float>& to) {
  to.resize(from.size());
  std::ranges::transform(from, to.begin(), [](double number) {
    return static_cast<float>(std::min<double>(number, std::numeric_limits<float>::max()));
  });
}
void narrow(const BendingValues<double>& from, BendingValues<float>& to) {
  narrow(from.value, to.value);
  narrow(from.mass, to.mass);
  narrow(from.diagonal, to.diagonal);
}

/// The largest stiffness of M^-1/2 K M^-1/2 = B. For positive x no swing is stiffer than the
/// largest (|B| x)_i / x_i, which falls from the largest sum of a row as x becomes |B| x (Collatz,
/// Wielandt): one light particle has stiff rows beside it, and a swing that is not as stiff.
double largest_stiffness(const BendingRows& rows) {
  constexpr int kTimes = 16;
  std::vector<double> root(rows.slots()), x(rows.slots(), 1.0), next(rows.slots(), 1.0);
  for (std::size_t slot = 0; slot < rows.slots(); ++slot)
    root[slot] = rows.bends(slot) ? 1 / std::sqrt(rows.doubles.mass[slot]) : 0;
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

BendingRows make_bending_rows(const Model& model) {
  BendingRows rows;
  if (model.bending.size() == 0) return rows;
  std::vector<std::vector<std::pair<std::uint32_t, double>>> entries(model.slots());
  for_each_product(model, [&](std::uint32_t row, std::uint32_t column, double value) {
    entries[row].emplace_back(column, value);
  });
  rows.doubles.mass.resize(model.slots());
  rows.doubles.diagonal.resize(model.slots());
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    for (const auto& [column, value] : entries[slot]) {
      if (column == slot) rows.doubles.diagonal[slot] += value;
    }
    if (rows.doubles.diagonal[slot] > 0) rows.doubles.mass[slot] = 1 / model.inverse_mass[slot];
    add_sorted(entries[slot], rows);
  }
  add_groups(rows);
  narrow(rows.doubles, rows.floats);
  rows.stiffest = largest_stiffness(rows);
  return rows;
}

std::size_t BendingRows::bytes() const {
  const auto of = [](const auto& v) {
    return bytes_of(v.value) + bytes_of(v.mass) + bytes_of(v.diagonal);
  };
  return columns.bytes() + bytes_of(values) + bytes_of(begin) + bytes_of(column) + of(floats) +
         of(doubles);
}

double count_that_bend(const BendingRows& rows) {
  double count = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) count += rows.bends(slot) ? 1 : 0;
  return count;
}

double mean_stiffness(const BendingRows& rows) {
  double sum = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.bends(slot)) sum += rows.doubles.diagonal[slot] / rows.doubles.mass[slot];
  }
  return sum / std::max(1.0, count_that_bend(rows));
}

}  // namespace weft
