/// The stiffness matrix K of all bending elements: of particle i, with the weight c_i, an element
/// of the stiffness k has the force - c_i k d, d = sum of c_j x_j. K is the same for x, y and z,
/// and has rows and columns of free particles alone.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "engine/lists.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class Model;

/// The law A = inertia M + stiffness K: 1/s^2, and a factor.
struct BendingLaw {
  double inertia = 0, stiffness = 1;
  friend bool operator==(const BendingLaw&, const BendingLaw&) = default;
};

struct BendingRows {
  Lists columns;               // per slot: slots, ascending, its own among them
  std::vector<double> values;  // in the order of columns.items, N/m
  // The same by groups of rows (simd::BendingMatrix).
  std::vector<std::uint32_t> begin;
  std::vector<std::int32_t> column;
  kernels::AlignedVector<float> floats;  // values
  // Per slot.
  kernels::AlignedVector<double> mass;  // kg; of what is fixed or in no element: 0
  kernels::AlignedVector<float> float_mass;
  std::vector<double> diagonal;  // of K

  double stiffest = 0;  // 1/s^2, no swing has a larger square of its frequency

  bool empty() const { return values.empty(); }
  std::size_t slots() const { return mass.size(); }
  std::size_t groups() const { return begin.empty() ? 0 : begin.size() - 1; }
  /// Whether it is free and in an element.
  bool bends(std::size_t slot) const { return mass[slot] > 0; }
  /// Values by groups. In doubles only stiff bending wants them.
  template <class Real>
  kernels::AlignedVector<Real> values_by_groups() const;
  template <class Real>
  simd::BendingMatrix<Real> matrix(const BendingLaw& law, const Real* by_groups) const {
    const Real* masses = nullptr;
    if constexpr (std::is_same_v<Real, float>)
      masses = float_mass.data();
    else
      masses = mass.data();
    return {begin.data(),
            column.data(),
            by_groups,
            masses,
            static_cast<Real>(law.inertia),
            static_cast<Real>(law.stiffness)};
  }
  std::size_t bytes() const;
};

BendingRows make_bending_rows(const Model& model);

/// How many particles bend.
double count_that_bend(const BendingRows& rows);
/// 1/s^2, the mean of K_ii / m_i over them.
double mean_stiffness(const BendingRows& rows);

}  // namespace weft
