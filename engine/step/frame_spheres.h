/// The paper's spheres in a frame of small steps: the particles that they touch, and particles that
/// went through one.
#pragma once

#include <algorithm>

#include "engine/spheres/passages.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/frame_places.h"
#include "engine/step/reporting.h"
#include "engine/tuning.h"

namespace weft {

class FrameSpheres {
 public:
  FrameSpheres(State& s, FramePlaces& places, StepReport& report)
      : s_(s), places_(places), report_(report) {}

  /// Pairs that may touch are found anew when something may have come from beyond them.
  void find_contacts(Team& team) {
    if (s_.model->has_spheres()) timed(report_, Stage::find_contacts, [&] { find(team); });
  }
  void watch_crossings(Team& team) {
    if (s_.model->has_spheres()) timed(report_, Stage::find_contacts, [&] { watch(team); });
  }
  /// The description's number, or kNoIndex.
  std::uint32_t passed_particle() const { return passed_particle_; }

 private:
  void find(Team& team) {
    const double way = s_.small_steps->largest_move(team);
    if (!s_.nearby.hold_after(way)) {
      places_.read(team);
      s_.nearby.find(*s_.model, *s_.kernels, s_.solved.view(), margin_for(way), s_.contacts);
    } else if (!s_.nearby.slots().empty()) {
      places_.read(s_.nearby.slots());
    }
    s_.nearby.list_contacts(*s_.model, s_.solved.view(), s_.contacts);
  }
  void watch(Team& team) {
    const double way = s_.small_steps->largest_move(team);
    s_.nearby.move(way);
    if (!may_have_passed(*s_.model, way)) return;
    s_.small_steps->read_starts(s_.substep_positions.view(), team);
    places_.read(team);
    const std::uint32_t passed = find_passage(*s_.model, *s_.kernels, s_.substep_positions.view(),
                                              s_.solved.view(), s_.contacts);
    if (passed != kNoIndex) passed_particle_ = s_.model->ordering.particle_at[passed];
  }
  /// m, for the substeps to come, if they go on as this one. Wider margins hold more pairs.
  double margin_for(double way) const {
    double radius = 0;
    for (const std::uint32_t sphere : s_.model->spheres)
      radius = std::max(radius, s_.model->radius[sphere]);
    const double left = places_.left() + 1;
    return std::min(tuning::kNearbySpare * way * left, tuning::kNearbyMost * radius);
  }

  State& s_;
  FramePlaces& places_;
  StepReport& report_;
  std::uint32_t passed_particle_ = kNoIndex;
};

}  // namespace weft
