/// Small steps in double, one block after the other: the text to read beside
/// engine/solvers/small_steps/simd_small_steps.h, with whose functions its own go by name and
/// order.
#pragma once

#include <weft/weft.h>

#include <iterator>
#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/arrivals.h"
#include "engine/solvers/small_steps/bending_pace.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/solvers/small_steps/point_particles.h"
#include "engine/solvers/small_steps/reference_bodies.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/reference/small_steps.h"

namespace weft {

class ReferenceSmallSteps final : public SmallSteps {
 public:
  struct Past {
    double h = 0;  // of the last substep; 0: there was none
    kernels::Vectors v, v_before, moved;
    std::vector<bool> at_limit;  // per anchor
    ReferenceBodies::Touching touching;
    Misplaced misplaced;

    friend void visit_fields(Is<Past> auto& past, auto& archive) {
      auto& [h, v, v_before, moved, at_limit, touching, misplaced] = past;
      archive(h, v, v_before, moved, at_limit, touching, misplaced);
    }
  };

  ReferenceSmallSteps(const Model& model, const Settings& settings, const simd::Table& table);

  void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
             kernels::VectorsView force, const FramePlan& plan, Team& team) override;
  void accelerate(kernels::Vector gravity, kernels::VectorsView force) override;
  void advance(Team& team) override;
  void sweep(Team& team) override;
  void mend(double to, Team& team) override;
  void judge(Team& team) override;
  std::int64_t count_out() const override { return std::ssize(out_); }
  LocalWork repair(const SphereContacts& contacts, std::int64_t most_visits, Team& team) override;
  LocalWork repair_everywhere(const SphereContacts& contacts, std::int64_t most_visits,
                              Team& team) override;
  double law_error() override;
  void end_seams() override;
  const SeamThreads& seams() const override { return seams_; }
  void report_bodies(BodyReport& report) override { bodies_.sum(report); }
  double deepest_in_body(Team& team) override;
  bool end_contacts(Team& team) override;
  void read_contacts(std::vector<BodyTouch>& contacts) override;
  void read_positions(kernels::VectorsView x, Team& team) const override;
  void read_positions_of(std::span<const std::uint32_t> slots,
                         kernels::VectorsView x) const override;
  void read_starts(kernels::VectorsView x, Team& team) const override;
  double largest_move(Team& team) override;
  double bending_energy(double give, Team& team) override;
  void settle(Team& team) override;
  void read_velocities(kernels::VectorsView v, Team& team) const override;
  double motion_error() const override { return departures_.mean_error(); }
  double rounding_error(double) const override { return 0; }

  void keep(Team& team) override;
  void take_past(const SmallSteps& from) override {
    past_ = static_cast<const ReferenceSmallSteps&>(from).past_;
  }
  void go_on_from(const SmallSteps& from, kernels::VectorsView v, kernels::Vector gravity) override;
  void forget_past() override { past_.h = 0; }
  void save_past(ArchiveWriter& archive) const override { archive(past_); }
  bool load_past(ArchiveReader& archive) override;
  void turn(const Turn& by) override;
  std::size_t bytes() const override;

 private:
  struct Points;
  using Particles = PointParticles<Points>;
  /// with_limits: anchors and bodies hold what is moved.
  Points points(bool with_limits);
  LawStep law_step() const;
  reference::Flight flight();
  bool is_free(std::size_t slot) const { return model_.inverse_mass[slot] > 0; }
  /// Of a substep of h_ after one of h_before.
  SubstepFormula formula_after(double h_before) const;
  double decaying_share() const;
  void decay();
  void settle_velocities();
  void bend();
  void measure_departure();
  reference::BendingElement element(std::uint32_t i) const {
    const BendingStore& s = model_.bending;
    return {s.slots[i], s.weights[i], s.rest[i], s.compliance[i]};
  }
  void relax_chain(std::span<const std::uint32_t> slots, std::span<const std::uint32_t> links);
  void relax_spring_chain(std::span<const std::uint32_t> slots,
                          std::span<const std::uint32_t> links);
  void apply_impulses(std::span<const std::uint32_t> slots);
  void judge_springs();
  void relax_edge(std::uint32_t constraint);
  void relax_spring(std::uint32_t constraint);
  void relax_membrane();
  void set_aside();
  void take_past_along();
  double left_by_sweep() const;
  void judge_membrane();
  void draw_seams();
  LocalWork run_passes(const SphereContacts& contacts, std::int64_t most_visits, Team& team);
  void hold_anchors();
  void hold_bodies(Team& team);
  void hold_by_meshes(Team& team);
  void begin_bodies(const FramePlan& plan);
  void advance_bodies(double part, Team& team);
  void end_motions();
  void stop_at_contact(std::size_t slot);
  void begin_at_limit(const Arrival& arrival);

  const Model& model_;
  const SmallStepsLayout& layout_;
  const Settings settings_;
  LocalPasses passes_;
  SeamThreads seams_;
  const bool has_attached_;  // which are where they belong before constraints are swept
  std::vector<BendingPace> paces_;
  AnchorClock anchors_;
  ReferenceBodies bodies_;
  Past past_;
  reference::ChainSystem system_;

  bool has_past_ = false;  // past_ is that of the present frame
  double h_ = 0, omega_ = 1;
  double last_ = 0;  // b h of the last substep
  SubstepFormula formula_, next_formula_;
  Departures departures_;
  kernels::Vectors x_, before_, predicted_, v_, v_before_, acceleration_;
  std::vector<std::uint32_t> out_;  // items (local_passes.h) that a sweep found out of tolerance
  std::vector<std::uint32_t> touched_;
  std::vector<Arrival> arrived_;
  const std::vector<double> shortest_;            // m, per slot: of its constraints
  std::vector<bool> at_limit_, at_limit_before_;  // per anchor, in this substep and in the last
  std::vector<double> multiplier_;                // per constraint; with springs only
  std::vector<reference::MembraneMultipliers> membrane_multiplier_;  // per triangle of fabric
  bool is_begun_ = false;                                            // the substep has been swept
  double mends_to_ = 0;                                              // share of the tolerance
  bool mends_ = false;                                               // the present sweep
  kernels::Vectors aside_;  // x_ before mending, with laws only
  bool is_aside_ = false;   // aside_ is that of this substep
  bool projects_ = false;
  double softest_ = 0;  // m/N, where it projects
};

}  // namespace weft
