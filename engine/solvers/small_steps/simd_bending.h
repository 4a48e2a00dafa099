/// The bending elements of small steps in lanes.
#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_frame.h"
#include "engine/solvers/small_steps/bending_layout.h"
#include "engine/solvers/small_steps/bending_system.h"

namespace weft {

class SimdBending {
 public:
  SimdBending(const Model& model, const Settings& settings, const simd::Table& table);

  /// Begins a frame with these accelerations of particles. goes_on: its substeps are as long as
  /// that before it.
  void begin(const FramePlan& plan, const float* acceleration, bool goes_on);
  /// Measures a new base.
  void measure_base(const float* base, Team& team);
  /// m, of a hinge that yields, in place of that of the model.
  void set_fold(std::uint32_t element, double fold);
  /// Whether it has bent in the present substep.
  bool has_bent() const { return frame_.is_solved_now(); }
  double resolved(double give) const { return frame_.resolved(give); }
  /// After the prediction of a substep whose positions move by give w f. start: where it began.
  void bend(float* u, const float* start, double give, Team& team);
  /// J, with positions at base + u, of substeps of `give`; 0: all of it.
  double energy(const float* u, double give, Team& team);
  /// J, of it what substeps of `give` can release (small_steps.h). After the last substep, and
  /// overwrites u.
  double releasable_energy(float* u, double give, Team& team);
  /// The largest share of a force of bending that a solution of the frame has left.
  double error() const { return error_; }
  std::size_t bytes() const;

 private:
  template <class Work>
  void for_blocks(Team& team, Work&& work) const;
  template <class Work>
  void for_floats(Team& team, Work&& work) const;
  simd::BendingSpans spans() {
    return {spans_.data(), along_.data(), across_.data(), sides_.data()};
  }
  simd::Bending arrays(const float* u);
  void pull(const float* u, const float* start, const BendingStep& step, Team& team);
  template <class Real>
  double released(BendingSystem<Real>& system, const float* force, const BendingLaw& law,
                  Team& team);
  bool begins_anew() const;
  void begin_from_guess(float* u, const float* start, const BendingStep& step, Team& team);
  void bend_softly(float* u, const float* start, const BendingStep& step, Team& team);
  void bend_stiffly(float* u, const float* start, const BendingStep& step, Team& team);
  /// Returns the share of the force that is left.
  double solve_stiffly(const float* u, const float* start, const BendingStep& step, Team& team);

  const Model& model_;
  const BendingLayout& layout_;
  const simd::Table& table_;
  BendingFrame frame_;
  BendingSystem<float> soft_;
  BendingSystem<double> stiff_;
  double give_ = 0;  // s^2, of the last solution in the frame; 0: there was none
  double error_ = 0;
  std::vector<simd::BendingFolds> folds_;                   // of now, if some yield
  kernels::AlignedVector<simd::EdgeSpans> spans_;           // d of the base
  kernels::AlignedVector<simd::EdgeSpans> along_, across_;  // arms of the base, for damping
  kernels::AlignedVector<simd::EdgeSpans> sides_;           // of the base, for folded hinges
  kernels::AlignedVector<float> from_;                      // the start that damping measures from
  std::vector<double> energies_;                            // J, per block
  std::vector<double> works_;                               // J, per part of the particles
};

}  // namespace weft
