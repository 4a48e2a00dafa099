/// The particles of small steps in double, one after the other: the text to read beside
/// lane_store.h. particle_store.h says what the operations do.
#pragma once

#include <iterator>
#include <optional>
#include <vector>

#include "engine/model/bending_element.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_frame.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "engine/solvers/small_steps/frame_to_do.h"
#include "engine/solvers/small_steps/point_particles.h"
#include "engine/solvers/small_steps/reference_bodies.h"
#include "engine/solvers/small_steps/substep.h"
#include "engine/turn.h"
#include "kernels/reference/bending.h"
#include "kernels/reference/small_steps.h"

namespace weft {

class ReferenceStore {
 public:
  struct Points;
  struct Past {
    double dt_substep = 0;  // of the last substep; 0: there was none
    kernels::Vectors v, v_before, moved;
    std::vector<bool> at_limit;  // per anchor
    ReferenceBodies::Touching touching;
    Misplaced misplaced;
    ContactMemory contacts;

    friend void visit_fields(Is<Past> auto& past, auto& archive) {
      auto& [dt_substep, v, v_before, moved, at_limit, touching, misplaced, contacts] = past;
      archive(dt_substep, v, v_before, moved, at_limit, touching, misplaced, contacts);
    }
  };

  ReferenceStore(Substep& now, const simd::Table& table);

  Points points(bool with_limits);
  ReferenceBodies& bodies() { return bodies_; }
  kernels::Vector velocity(std::uint32_t slot) const { return v_[slot]; }
  kernels::Vector velocity_before(std::uint32_t slot) const { return v_before_[slot]; }

  void begin(kernels::VectorsView x, kernels::VectorsView v, const FramePlan& plan, Team& team);
  void accelerate(kernels::Vector gravity, kernels::VectorsView force);
  void begin_bending(const FramePlan& plan);
  void begin_past(Team& team);
  void renew_base(Team&) {}
  std::optional<double> predict(Team& team);
  void decay(double to, Team& team);
  void bend(Team& team);

  template <class After>
  void sweep_yarns(const Relaxation& by, Team&, After&& after) {
    out_.clear();
    for (std::size_t family = 0; family < layout_.yarns.families(); ++family) {
      for_each_yarn(layout_.yarns, family, [&](std::span<const std::uint32_t> links) {
        relax_chain(slots_of(model_.constraints, links), links, by);
      });
      after();
    }
  }
  void sweep_edges(const Relaxation& by, Team&) {
    for (const std::uint32_t c : layout_.constraint) {
      if (c != kNoIndex) relax_edge(c, by);
    }
    for (const std::uint32_t c : layout_.serial) relax_edge(c, by);
  }
  void sweep_membrane(Team& team);
  void judge_springs(Team& team);
  void judge_membrane(Team& team);
  std::int64_t count_out() const { return std::ssize(out_); }
  template <class Work>
  void for_each_out(Work&& work) const {
    for (const std::uint32_t item : out_) work(item);
  }

  void advance_anchors();
  void begin_bodies(const FramePlan& plan);
  void advance_bodies(double part, Team& team);
  void hold_anchors(Team& team);
  void hold_bodies(Team& team);
  void hold_by_meshes(Team& team);
  double deepest_in_body(Team& team);
  void stop_at_contact(std::uint32_t slot);
  void begin_at_limit(std::uint32_t slot);
  void jump_velocity(std::uint32_t slot, kernels::Vector by);

  void set_aside() { aside_ = x_; }
  void take_past_along(Team& team);
  std::optional<double> settle(bool measures, Team& team);
  void read_positions(kernels::VectorsView x, Team& team) const;
  void read_positions_of(std::span<const std::uint32_t> slots, kernels::VectorsView x) const;
  void read_starts(kernels::VectorsView x, Team& team) const;
  void read_velocities(kernels::VectorsView v, Team& team) const;
  double largest_move(Team& team);
  double bending_energy(double give, Team& team);
  double releasable_bending_energy(kernels::VectorsView x, double give, Team& team);
  double bending_error() const { return bending_error_; }
  bool has_bent() const { return bending_frame_.is_solved_now(); }
  double resolved_bending(double give) const { return bending_frame_.resolved(give); }
  void set_fold(std::uint32_t element, double fold) { folds_[element] = fold; }
  double rounding_error(double) const { return 0; }

  double dt_of_past() const { return past_.dt_substep; }
  void keep(Team& team);
  void take_past(const ReferenceStore& from) { past_ = from.past_; }
  void go_on_from(const ReferenceStore& other, kernels::VectorsView v, kernels::Vector gravity);
  void forget_past() { past_.dt_substep = 0; }
  void save_past(ArchiveWriter& archive) const { archive(past_); }
  bool load_past(ArchiveReader& archive);
  void turn(const Turn& by);
  std::size_t bytes() const;

 private:
  reference::Flight flight();
  std::optional<double> departure();
  void pull(const BendingStep& step);
  reference::BendingElement element(std::uint32_t i) const {
    reference::BendingElement element = element_of(model_.bending, i);
    element.beside = layout_.bending.beside[i];
    if (element.yields) element.fold = folds_[i];
    return element;
  }
  /// Relaxes the errors l^2 / rest^2 - 1.
  void relax_chain(std::span<const std::uint32_t> slots, std::span<const std::uint32_t> links,
                   const Relaxation& by);
  void relax_spring_chain(std::span<const std::uint32_t> slots,
                          std::span<const std::uint32_t> links);
  void apply_impulses(std::span<const std::uint32_t> slots);
  void relax_edge(std::uint32_t constraint, const Relaxation& by);
  void relax_spring(std::uint32_t constraint);

  Substep& now_;
  const Model& model_;
  const SmallStepsLayout& layout_;
  BendingFrame bending_frame_;
  BendingSystem<double> bending_;
  double give_ = 0, bending_error_ = 0;  // as SimdBending has them
  std::vector<double> folds_ =           // m, per element, if some yield
      model_.bending.may_yield() ? model_.bending.fold : std::vector<double>{};
  AnchorClock anchors_;
  ReferenceBodies bodies_;
  Past past_;
  reference::ChainSystem system_;
  double last_ = 0;  // b h of the last substep; 0: velocities are settled
  kernels::Vectors x_, before_, predicted_, v_, v_before_, acceleration_, from_;
  std::vector<std::uint32_t> out_;      // items (local_passes.h) that were found out of tolerance
  const std::vector<double> shortest_;  // m, per slot: of its constraints
  std::vector<bool> at_limit_, at_limit_before_;  // per anchor, in this substep and in the last
  std::vector<double> multiplier_;                // per constraint; with springs only
  std::vector<reference::MembraneMultipliers> membrane_multiplier_;  // per triangle of fabric
  kernels::Vectors aside_;   // x_ before mending, with laws only
  ParticlesAtHand at_hand_;  // scratch of sweeps
};

/// As local passes, anchors and bodies see and move them; in lanes: lane_points.h.
struct ReferenceStore::Points {
  kernels::VectorsView x, predicted, start;
  std::vector<std::uint32_t>& touched;
  std::vector<double>& multipliers;
  kernels::VectorsView v;
  double rate;                     // by which it settles
  const std::uint32_t* anchor_at;  // per slot, or null: anchors are left
  const AnchorClock& anchors;
  std::vector<reference::MembraneMultipliers>& of_membrane;
  ReferenceBodies* bodies;  // or null: they are left
  std::vector<Arrival>& arrived;
  std::vector<VelocityJump>& velocity_jumps;
  kernels::VectorsView led_to;  // as simd::Flight has it

  bool is_mended() const { return led_to.x != x.x; }
  kernels::Vector position(std::uint32_t slot) const { return x[slot]; }
  kernels::Vector position_at_start(std::uint32_t slot) const { return start[slot]; }
  kernels::Vector settled(std::uint32_t slot) const {
    return v[slot] + rate * (led_to[slot] - predicted[slot]);
  }
  void move_to(std::uint32_t slot, kernels::Vector position) const { x.set(slot, position); }
  /// Its stop by contacts is no motion: it is predicted to be where it is.
  void put(std::uint32_t slot, kernels::Vector position, kernels::Vector velocity) const {
    x.set(slot, position);
    predicted.set(slot, led_to[slot]);
    v.set(slot, velocity);
  }
  ParticleAtHand take(std::uint32_t slot) const {
    return {start[slot], x[slot], predicted[slot], led_to[slot], v[slot], is_mended()};
  }
  void put_back(std::uint32_t slot, const ParticleAtHand& hand) const {
    x.set(slot, hand.x);
    start.set(slot, hand.start);
    predicted.set(slot, hand.predicted);
    if (hand.is_mended) led_to.set(slot, hand.led_to);
    v.set(slot, hand.v);
  }
  kernels::Vector difference(std::uint32_t a, std::uint32_t b) const { return x[a] - x[b]; }
  void move(std::uint32_t slot, kernels::Vector by) const {
    x.add(slot, by);
    if (anchor_at != nullptr && anchor_at[slot] != kNoIndex) hold(slot, anchor_at[slot]);
    if (bodies != nullptr) solve_contacts(slot);
  }
  bool hold(std::uint32_t slot, std::uint32_t anchor) const {
    const reference::Held held = anchors.hold(anchor, x[slot], settled(slot));
    if (held.is_at_limit) put(slot, held.x, held.v);
    return held.is_at_limit;
  }
  bool solve_contacts(std::uint32_t slot) const;
  bool solve_body_contacts(std::uint32_t slot) const {
    ParticleAtHand hand = take(slot);
    const bool is_held = hold_by_bodies(*this, slot, hand);
    if (is_held) put_back(slot, hand);
    return is_held;
  }
  void push(std::uint32_t slot, kernels::Vector by) const {
    move(slot, by);
    touched.push_back(slot);
  }
  kernels::Vector start_difference(std::uint32_t a, std::uint32_t b) const {
    return start[a] - start[b];
  }
  double multiplier(std::uint32_t c) const { return multipliers[c]; }
  void set_multiplier(std::uint32_t c, double to) const { multipliers[c] = to; }
  const reference::MembraneMultipliers& membrane_multipliers(std::uint32_t element) const {
    return of_membrane[element];
  }
  void set_membrane_multipliers(std::uint32_t element,
                                const reference::MembraneMultipliers& to) const {
    of_membrane[element] = to;
  }
};

}  // namespace weft
