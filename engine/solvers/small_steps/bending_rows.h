/// The stiffness matrix K of all bending elements: of particle i, with the weight c_i, an element
/// of the stiffness k has the force - c_i k d, d = sum of c_j x_j. K is the same for x, y and z,
/// and has rows and columns of free particles alone.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/lists.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class Model;

struct BendingRows {
  Lists columns;               // per slot: slots, ascending, its own among them
  std::vector<double> values;  // in the order of columns.items, N/m
  // The same by groups of rows (simd::BendingMatrix).
  std::vector<std::uint32_t> begin, column;
  kernels::AlignedVector<double> value;
  kernels::AlignedVector<double> mass;      // per slot, kg; of what is fixed: 0
  kernels::AlignedVector<double> diagonal;  // per slot, of K

  bool empty() const { return values.empty(); }
  std::size_t slots() const { return mass.size(); }
  std::size_t groups() const { return begin.empty() ? 0 : begin.size() - 1; }
  simd::BendingMatrix matrix(double inertia, double stiffness) const {
    return {begin.data(), column.data(), value.data(), mass.data(), inertia, stiffness};
  }
  std::size_t bytes() const;
};

BendingRows make_bending_rows(const Model& model);

}  // namespace weft
