/// The present substep, as small_steps.cpp and the store of particles (lane_store.h,
/// reference_store.h) share it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/arrivals.h"
#include "engine/solvers/small_steps/laws.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/solvers/small_steps/membrane_laws.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/substep_formula.h"
#include "engine/tuning.h"

namespace weft {

struct Substep {
  const Model& model;
  const Settings settings;
  LocalPasses passes{model, model.small_steps().items};

  double dt_substep = 0, omega = 1;          // FramePlan
  std::optional<double> softest{};           // likewise
  bool has_past = false;                     // the past of the store is that of the present frame
  SubstepFormula formula{}, next_formula{};  // of the present substep, and of the next
  bool is_begun = false;                     // it has been swept
  bool is_aside = false;                     // positions before mending were set aside
  std::vector<std::uint32_t> touched{};      // slots that contacts have pushed
  std::vector<Arrival> arrived{};
  std::vector<VelocityJump> velocity_jumps{};
  double stiffest = stiffest_law(model.membrane);

  bool is_free(std::size_t slot) const { return model.inverse_mass[slot] > 0; }
  bool measures_departures() const { return settings.motion_tolerance > 0; }
  /// Strain at which local passes look at a constraint.
  double local_tolerance() const { return tuning::kLocalShare * settings.tolerance; }
  LawStep law_step() const {
    if (softest) return {{1 / (dt_substep * dt_substep), 0}, *softest};
    const double give = formula.give(dt_substep), damping = model.damping.stretch / dt_substep;
    return {.springs = {1 / give, damping}, .damping_of_triangles = dampable(damping, give)};
  }
  /// The part of a damping with which one sweep still holds the laws of triangles at rest. A visit
  /// of a law that is too stiff, with its damping, is relaxed (reference::MembraneLaw::impulse).
  /// The law is as many times softer then.
  double dampable(double damping, double give) const {
    const double own = give * stiffest, most_own = 1 / (1 / omega - 0.5);
    if (own == 0) return damping;
    return std::min(damping, std::max(most_own / own - 1, tuning::kLeastDamping));
  }
  /// The formula of a substep of dt_substep after one of dt_before.
  SubstepFormula formula_after(double dt_before) const {
    return SubstepFormula::of(settings.scheme, dt_substep / dt_before)
        .with_decay(model.damping.motion, dt_substep, dt_before);
  }
  /// The share of dt_substep in which accelerations act in a flight.
  double decaying_share() const {
    return SubstepFormula{}.with_decay(model.damping.motion, dt_substep, dt_substep).share;
  }
  std::size_t bytes() const {
    return passes.bytes() + bytes_of(touched) + bytes_of(arrived) + bytes_of(velocity_jumps);
  }
};

/// Whether slots that were read are some of the model's, ascending.
inline bool are_slots(const Model& model, std::span<const std::uint32_t> slots) {
  return std::ranges::is_sorted(slots) && (slots.empty() || slots.back() < model.slots());
}

/// How far a sweep goes with rigid constraints.
struct Relaxation {
  double omega = 1;
  double left = 0;  // strain that they may keep
};

}  // namespace weft
