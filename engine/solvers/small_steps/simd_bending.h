/// The bending elements of small steps in lanes.
#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_pace.h"

namespace weft {

class SimdBending {
 public:
  SimdBending(const Model& model, const simd::Table& table);

  void begin(const FramePlan& plan) {
    for (BendingPace& pace : paces_) pace.begin(plan);
  }
  /// Of a new base.
  void measure_base(const float* base, Team& team);
  /// After the prediction of a substep whose positions move by give w f; v: the velocity in its
  /// beginning.
  void bend(float* u, const float* v, double give, Team& team);
  /// J, with positions at base + u, of substeps of b h.
  double energy(float* u, double give, Team& team);
  std::size_t bytes() const;

 private:
  simd::Bending arrays(float* u) const;
  /// work(is of four, first, last) over the blocks, batch by batch.
  template <class Work>
  void for_blocks(std::span<const BendingBatch> batches, Team& team, Work&& work) const;

  const BendingLayout& layout_;
  const simd::Table& table_;
  std::vector<BendingPace> paces_;
  kernels::AlignedVector<simd::EdgeSpans> spans_;  // d of the base
  std::vector<double> energies_;                   // J, per block
};

}  // namespace weft
