/// Small steps: one relaxed sweep over all constraints in each of many substeps, and then passes
/// over those alone that are out of tolerance. This is what a frame (engine/step/small_step.cpp)
/// asks of them; SmallStepsSolver answers in lanes, ReferenceSmallSteps in double.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>

#include "engine/contacts/contacts.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/anchor_travel.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/turn.h"
#include "kernels/vectors.h"

namespace weft {

class Model;
namespace simd {
struct Table;
}

/// BDF2 with the step before, or the first-order method (kernels/simd/small_steps.h).
struct SubstepFormula {
  double past = 0;  // c
  double part = 1;  // b
  static SubstepFormula of(Scheme scheme, double ratio) {
    if (scheme != Scheme::bdf2) return {};
    return {ratio * ratio / (1 + 2 * ratio), (1 + ratio) / (1 + 2 * ratio)};
  }
};

/// What a step is done in.
struct FramePlan {
  double h = 0;  // s, of a substep
  int substeps = 1;
  double omega = 1;       // of a sweep
  bool placed = false;    // positions are not where the last step ended: nothing is known of a past
  bool projects = false;  // no time passes: springs are left as they are
  AnchorTravel anchors{};
};

class SmallSteps {
 public:
  virtual ~SmallSteps() = default;

  /// s, of the longest substep that leaves little to local passes.
  virtual double substep_length(kernels::VectorsView x, double acceleration) const = 0;

  /// A frame from x, with velocities v.
  virtual void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
                     kernels::VectorsView force, const FramePlan& plan, Team& team) = 0;
  /// The stages of a substep.
  virtual void advance(Team& team) = 0;
  virtual void sweep(Team& team) = 0;
  /// Constraints that the last sweep found out of tolerance.
  virtual std::int64_t count_out() const = 0;
  virtual LocalWork repair(const ContactStore& contacts, std::int64_t most_visits) = 0;
  /// After the last: local passes that look at all constraints.
  virtual LocalWork repair_everywhere(const ContactStore& contacts, std::int64_t most_visits) = 0;
  /// What is left of the laws of all constraints, the largest, over rest_length. With springs only.
  virtual double law_error() = 0;
  /// Where the particles are; x: where they were when the frame began.
  virtual void read_positions(kernels::VectorsView x, Team& team) const = 0;
  /// J, of the bending elements, where the particles are; of those that substeps are too long for
  /// no more than they resolve.
  virtual double bending_energy(Team& team) = 0;
  /// After the last substep.
  virtual void settle(Team& team) = 0;
  virtual void read_velocities(kernels::VectorsView v, Team& team) const = 0;
  /// The frame becomes the past of the next one. Without this the one before stays.
  virtual void keep(Team& team) = 0;
  /// Goes on where another one of the same kind is.
  virtual void take_past(const SmallSteps& from) = 0;
  virtual void forget_past() = 0;
  /// The past happened in other directions. Positions are new ones.
  virtual void turn(const Turn& by) = 0;
  virtual std::size_t bytes() const = 0;
};

/// On the backend of the settings.
std::unique_ptr<SmallSteps> make_small_steps(const Model& model, const Settings& settings,
                                             const simd::Table& table);

}  // namespace weft
