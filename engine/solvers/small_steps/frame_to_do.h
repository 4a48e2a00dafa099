/// The work that a frame asks of small steps.
#pragma once

#include <optional>
#include <span>

#include "engine/contact/interval.h"
#include "engine/model/bending_element.h"
#include "engine/solvers/small_steps/anchor_travel.h"
#include "engine/solvers/small_steps/seams.h"
#include "engine/solvers/small_steps/sliders.h"

namespace weft {

/// The plan of a frame (engine/step/frame_plan.h makes it).
struct FramePlan {
  double dt_substep = 0;  // s, of a substep
  int substeps = 1;
  double passes = 0;    // at most, beyond a sweep for each substep, in the time of sweeps
  double omega = 1;     // of a sweep
  bool placed = false;  // positions are not where the last step ended: nothing is known of a past
  // m/N. A start is projected (engine/step/project.h) and the past is kept: springs that are softer
  // are left as they are.
  std::optional<double> softest{};
  AnchorTravel anchors{};
  std::span<const SeamState> seams{};
  std::span<const reference::RailPlace> sliders{};
  std::span<const Crease> creases{};
  std::span<const TravellingBody> bodies{};
  std::span<const FreeBody> free{};  // those that move by themselves
  bool bodies_move = false;          // in this step, or in the last, or there are other ones
  bool bodies_are_new = false;       // there are other ones, or one was put elsewhere

  double refinement = 0;      // log2: substeps are so much shorter than is known beforehand
  bool may_be_finer = false;  // another attempt may follow, with twice as many substeps
  bool goes_on = false;       // a projection from where the last one ended, in the same step

  bool projects() const { return softest.has_value(); }
  ContactStart contact_start() const {
    if (goes_on) return ContactStart::goes_on;
    return placed || bodies_are_new ? ContactStart::anew : ContactStart::known;
  }
};

}  // namespace weft
