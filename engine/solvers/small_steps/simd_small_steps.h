/// Small steps in lanes.
///
/// A sweep goes over blocks, yarns that are solved exactly and single constraints, along directions
/// that are renewed as it goes (kernels/simd/small_steps.h, small_step_yarns.h). What it leaves of
/// a load is a strain that falls with the square of the substep (small_steps_load.h): the number of
/// substeps is chosen so that few constraints are left to local passes. A substep's length must not
/// change much: a strain is a loaded spring, which a shorter step stiffens.
#pragma once

#include <weft/weft.h>

#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/lane_points.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/solvers/small_steps/simd_anchors.h"
#include "engine/solvers/small_steps/simd_bending.h"
#include "engine/solvers/small_steps/simd_bodies.h"
#include "engine/solvers/small_steps/simd_links.h"
#include "engine/solvers/small_steps/simd_membrane.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/simd/table.h"

namespace weft {

/// What is left of a flight between two frames, in the layout of the solver.
struct SmallStepsPast {
  double h = 0;           // of the last substep; 0: there was none
  int since_renewal = 0;  // substeps with the present base
  kernels::AlignedVector<float> v, v_before, moved;
  kernels::AlignedVector<float> base;  // of a frame that is kept
  SimdAnchors::AtLimit at_limit;
  SimdBodies::Touching touching;
  Misplaced misplaced;

  friend void visit_fields(Is<SmallStepsPast> auto& past, auto& archive) {
    auto& [h, since_renewal, v, v_before, moved, base, at_limit, touching, misplaced] = past;
    archive(h, since_renewal, v, v_before, moved, base, at_limit, touching, misplaced);
  }
};

class SmallStepsSolver final : public SmallSteps {
 public:
  SmallStepsSolver(const Model& model, const Settings& settings, const simd::Table& table);

  /// A frame from x, with velocities v.
  void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
             kernels::VectorsView force, const FramePlan& plan, Team& team) override;
  void accelerate(kernels::Vector gravity, kernels::VectorsView force) override {
    write_acceleration(gravity, force);
  }
  /// The stages of a substep.
  void advance(Team& team) override;
  void sweep(Team& team) override;
  void mend(double to, Team& team) override;
  void judge(Team& team) override;
  /// Constraints that the last sweep found out of tolerance.
  std::int64_t count_out() const override;
  LocalWork repair(const SphereContacts& contacts, std::int64_t most_visits, Team& team) override;
  /// After the last: local passes that look at all constraints.
  LocalWork repair_everywhere(const SphereContacts& contacts, std::int64_t most_visits,
                              Team& team) override;
  double law_error() override;
  void end_seams() override;
  const SeamThreads& seams() const override { return seams_; }
  void report_bodies(BodyReport& report) override;
  double deepest_in_body(Team& team) override;
  bool end_contacts(Team& team) override;
  void read_contacts(std::vector<BodyTouch>& contacts) override;
  /// Where the particles are; x: where they were when the frame began.
  void read_positions(kernels::VectorsView x, Team& team) const override;
  void read_positions_of(std::span<const std::uint32_t> slots,
                         kernels::VectorsView x) const override;
  void read_starts(kernels::VectorsView x, Team& team) const override;
  double largest_move(Team& team) override;
  double bending_energy(double give, Team& team) override;
  /// After the last substep.
  void settle(Team& team) override;
  void read_velocities(kernels::VectorsView v, Team& team) const override;
  double motion_error() const override { return departures_.mean_error(); }
  double rounding_error(double h) const override;
  /// The frame becomes the past of the next one. Without this the one before stays.
  void keep(Team& team) override;
  void take_past(const SmallSteps& from) override;
  void go_on_from(const SmallSteps& from, kernels::VectorsView v, kernels::Vector gravity) override;
  void forget_past() override { past_.h = 0; }
  void save_past(ArchiveWriter& archive) const override { archive(last_past()); }
  bool load_past(ArchiveReader& archive) override;
  void turn(const Turn& by) override;

  std::size_t bytes() const override;

 private:
  /// with_limits: anchors and bodies hold what is moved.
  LanePoints points(bool with_limits);
  LawStep law_step() const;
  simd::Flight flight();
  void write_acceleration(kernels::Vector gravity, kernels::VectorsView force);
  void begin_past(Team& team);
  SmallStepsPast last_past() const;
  void set_past(SmallStepsPast&& past);
  /// Of a substep of h_ after one of h_before.
  SubstepFormula formula_after(double h_before) const;
  double decaying_share() const;
  void decay(double to, Team& team);
  void settle_velocities(bool measures, Team& team);
  void write_past(std::uint32_t slot, const ParticlePast& past);
  void split(kernels::VectorsView x, int substeps, Team& team);
  void measure_base(Team& team);
  void renew_base(Team& team);
  LinkSweep link_sweep();
  void sweep(const LinkSweep& links, Team& team);
  void set_aside();
  void take_past_along(Team& team);
  void judge_springs(Team& team);
  void sweep_serial(const LinkSweep& sweep);
  void sweep_serial_springs();
  void sweep_membrane(Team& team);
  void judge_membrane(Team& team);
  void look_near_what_was_out();
  void draw_seams();
  LocalWork run_passes(const SphereContacts& contacts, std::int64_t most_visits, Team& team);
  void hold_anchors(Team& team);
  void hold_bodies(Team& team);
  void hold_by_meshes(Team& team);
  void begin_bodies(const FramePlan& plan);
  void advance_bodies(double part, Team& team);
  void end_motions();
  void stop_at_contact(std::uint32_t slot);
  void begin_at_limit(const Arrival& arrival);
  template <class Work>
  void for_floats(Team& team, Work&& work);
  template <class Work>
  void settle_floats(Team& team, Work&& work);
  double largest_of_parts() const;

  const Model& model_;
  const SmallStepsLayout& layout_;
  const Settings settings_;
  const simd::Table& table_;
  LocalPasses passes_;
  SeamThreads seams_;
  const bool has_attached_;  // which are where they belong before constraints are swept
  SimdLinks links_;
  SimdMembrane membrane_;
  SimdBending bending_;
  SimdAnchors anchors_;
  SimdBodies bodies_;
  SmallStepsPast past_;

  bool has_past_ = false;  // past_ is that of the present frame

  double h_ = 0, omega_ = 1;
  simd::SubstepWeights weights_;
  Departures departures_;
  SubstepFormula formula_, next_formula_;  // of the present substep, and of the next
  int since_renewal_ = 0;
  kernels::Vector gravity_{};
  bool has_force_ = true;      // in acceleration_
  bool is_new_ = false;        // base_, of a frame that is not kept yet; past_ has the one before
  bool is_unmeasured_ = true;  // base_: spans of constraints and elements are of another

  kernels::AlignedVector<float> base_, u_, u_before_, predicted_, v_, v_before_, acceleration_;
  std::vector<std::uint32_t> touched_;  // slots that contacts have pushed
  std::vector<float> largest_;          // departure or move, per part of floats
  std::vector<Arrival> arrived_;
  bool is_begun_ = false;                // the substep has been swept
  kernels::AlignedVector<float> aside_;  // u_ before mending, with laws only
  bool is_aside_ = false;                // aside_ is that of this substep
  bool projects_ = false;
  double softest_ = 0;  // m/N, where it projects
};

}  // namespace weft
