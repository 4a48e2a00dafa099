/// The particles of small steps in lanes; in double: reference_store.h. particle_store.h says what
/// the operations do.
///
/// A sweep goes over blocks, yarns that are solved exactly and single constraints, along directions
/// that are renewed as it goes (kernels/simd/small_steps.h, small_step_yarns.h). A sweep
/// leaves a strain that falls with the square of the substep (small_steps_load.h): the number of
/// substeps is chosen so that local passes have few constraints to correct. A substep's length must
/// not change much: a strain is a loaded spring, which a shorter step stiffens.
#pragma once

#include <optional>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/frame_to_do.h"
#include "engine/solvers/small_steps/lane_points.h"
#include "engine/solvers/small_steps/simd_anchors.h"
#include "engine/solvers/small_steps/simd_bending.h"
#include "engine/solvers/small_steps/simd_bodies.h"
#include "engine/solvers/small_steps/simd_links.h"
#include "engine/solvers/small_steps/simd_membrane.h"
#include "engine/solvers/small_steps/substep.h"
#include "engine/turn.h"
#include "kernels/simd/table.h"

namespace weft {

/// The past of a flight between two frames, in the layout of the solver.
struct SmallStepsPast {
  double dt_substep = 0;  // of the last substep; 0: there was none
  int since_renewal = 0;  // substeps with the present base
  kernels::AlignedVector<float> v, v_before, moved;
  kernels::AlignedVector<float> base;  // of a frame that is kept
  SimdAnchors::AtLimit at_limit;
  SimdBodies::Touching touching;
  Misplaced misplaced;
  ContactMemory contacts;

  friend void visit_fields(Is<SmallStepsPast> auto& past, auto& archive) {
    auto& [dt_substep, since_renewal, v, v_before, moved, base, at_limit, touching, misplaced,
           contacts] = past;
    archive(dt_substep, since_renewal, v, v_before, moved, base, at_limit, touching, misplaced,
            contacts);
  }
};

class LaneStore {
 public:
  using Points = LanePoints;

  LaneStore(Substep& now, const simd::Table& table);

  LanePoints points(bool with_limits);
  SimdBodies& bodies() { return bodies_; }
  kernels::Vector velocity(std::uint32_t slot) { return points(false).vector(v_.data(), slot); }
  kernels::Vector velocity_before(std::uint32_t slot) {
    return points(false).vector(v_before_.data(), slot);
  }

  void begin(kernels::VectorsView x, kernels::VectorsView v, const FramePlan& plan, Team& team);
  void accelerate(kernels::Vector gravity, kernels::VectorsView force);
  void begin_bending(const FramePlan& plan);
  void begin_past(Team& team);

  void renew_base(Team& team);
  std::optional<double> settle(bool measures, Team& team);
  void decay(double to, Team& team);
  std::optional<double> predict(Team& team);
  void bend(Team& team) { bending_.bend(u_.data(), u_before_.data(), give(), team); }

  template <class After>
  void sweep_yarns(const Relaxation& by, Team& team, After&& after) {
    links_.sweep_yarns(link_sweep(by), team, after);
  }
  void sweep_edges(const Relaxation& by, Team& team);
  void sweep_membrane(Team& team);
  void judge_springs(Team& team);
  void judge_membrane(Team& team);
  std::int64_t count_out() const { return links_.count_out() + membrane_.count_out(); }
  template <class Work>
  void for_each_out(Work&& work) const {
    links_.for_each_out(work);
    membrane_.for_each_out(
        [&](std::uint32_t element) { work(now_.passes.item_of_element(element)); });
  }

  void advance_anchors() { anchors_.advance(); }
  void begin_bodies(const FramePlan& plan);
  void advance_bodies(double part, Team& team);
  void hold_anchors(Team& team);
  void hold_bodies(Team& team);
  void hold_by_meshes(Team& team);
  double deepest_in_body(Team& team);
  void stop_at_contact(std::uint32_t slot);
  void begin_at_limit(std::uint32_t slot);
  void jump_velocity(std::uint32_t slot, kernels::Vector by);
  void set_aside() { std::ranges::copy(u_, aside_.begin()); }
  void take_past_along(Team& team);

  void read_positions(kernels::VectorsView x, Team& team) const;
  void read_positions_of(std::span<const std::uint32_t> slots, kernels::VectorsView x) const;
  void read_starts(kernels::VectorsView x, Team& team) const;
  void read_velocities(kernels::VectorsView v, Team& team) const;
  double largest_move(Team& team);
  double bending_energy(double give, Team& team) { return bending_.energy(u_.data(), give, team); }
  double releasable_bending_energy(kernels::VectorsView x, double give, Team& team);
  double bending_error() const { return bending_.error(); }
  bool has_bent() const { return bending_.has_bent(); }
  double resolved_bending(double give) const { return bending_.resolved(give); }
  void set_fold(std::uint32_t element, double fold) { bending_.set_fold(element, fold); }
  double rounding_error(double h) const;

  double dt_of_past() const { return past_.dt_substep; }
  void keep(Team& team);
  void take_past(const LaneStore& from);
  void go_on_from(const LaneStore& other, kernels::VectorsView v, kernels::Vector gravity);
  void forget_past() { past_.dt_substep = 0; }
  void save_past(ArchiveWriter& archive) const { archive(last_past()); }
  bool load_past(ArchiveReader& archive);
  void turn(const Turn& by);
  std::size_t bytes() const;

 private:
  simd::Flight flight();
  double give() const { return now_.formula.give(now_.dt_substep); }
  SmallStepsPast last_past() const;
  void set_past(SmallStepsPast&& past);
  void write_past(std::uint32_t slot, const ParticlePast& past);
  void split(kernels::VectorsView x, int substeps, Team& team);
  void measure_base(Team& team);
  LinkSweep link_sweep(const Relaxation& by);
  void sweep_serial(const LinkSweep& sweep);
  void sweep_serial_springs();
  template <class Work>
  void for_floats(Team& team, Work&& work);
  template <class Work>
  std::optional<double> settle_floats(Team& team, Work&& work);
  double largest_of_parts() const;

  Substep& now_;
  const Model& model_;
  const SmallStepsLayout& layout_;
  const simd::Table& table_;
  SimdLinks links_;
  SimdMembrane membrane_;
  SimdBending bending_;
  SimdAnchors anchors_;
  SimdBodies bodies_;
  SmallStepsPast past_;
  simd::SubstepWeights weights_;
  int since_renewal_ = 0;
  kernels::Vector gravity_{};
  bool has_force_ = true;      // in acceleration_
  bool is_new_ = false;        // base_, of a frame that is not kept yet; past_ has the one before
  bool is_unmeasured_ = true;  // base_: spans of constraints and elements are of another

  kernels::AlignedVector<float> base_, u_, u_before_, predicted_, v_, v_before_, acceleration_;
  kernels::AlignedVector<float> aside_;  // u_ before mending, with laws only
  ParticlesAtHand at_hand_;              // scratch of sweeps
  std::vector<float> largest_;           // departure or move, per part of floats
};

}  // namespace weft
