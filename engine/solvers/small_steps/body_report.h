/// The effects of contacts with bodies in a frame.
#pragma once

#include <vector>

#include "engine/bodies/bodies.h"
#include "engine/contact/rescue_report.h"
#include "engine/contact/touch.h"

namespace weft {

struct BodyReport {
  std::vector<BodyImpulse> impulses;   // per body, of what it gave to the cloth
  double work = 0;                     // J, that bodies did on the cloth
  double friction = 0;                 // J, that friction took
  double untangling = 0;               // J, by what draws tangles apart
  int contacts = 0, within_cloth = 0;  // when the last substep ended
  RescueReport failures;               // of meshes

  void clear() {
    impulses.clear();
    work = friction = untangling = 0;
    contacts = within_cloth = 0;
    failures = {};
  }
};

}  // namespace weft
