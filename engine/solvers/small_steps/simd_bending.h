/// The bending elements of small steps in lanes.
#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_layout.h"
#include "engine/solvers/small_steps/bending_solver.h"

namespace weft {

class SimdBending {
 public:
  SimdBending(const Model& model, const Settings& settings, const simd::Table& table);

  /// As BendingSolver's; of a frame with these accelerations of particles.
  void begin(const FramePlan& plan, const float* acceleration);
  /// Of a new base.
  void measure_base(const float* base, Team& team);
  /// After the prediction of a substep whose positions move by give w f; v: as predicted.
  void bend(float* u, const float* v, double give, Team& team);
  /// J, with positions at base + u, of substeps of `give`.
  double energy(const float* u, double give, Team& team);
  double error() const { return solver_.error(); }
  std::size_t bytes() const;

 private:
  template <class Work>
  void for_blocks(Team& team, Work&& work) const;
  template <class Work>
  void for_slots(Team& team, Work&& work) const;

  const Model& model_;
  const BendingLayout& layout_;
  const simd::Table& table_;
  BendingSolver solver_;
  kernels::AlignedVector<simd::EdgeSpans> spans_;  // d of the base
  kernels::AlignedVector<float> pulls_;            // in quads
  std::vector<double> energies_;                   // J, per block
};

}  // namespace weft
