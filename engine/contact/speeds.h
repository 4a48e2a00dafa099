/// How fast a cloth and the bodies that are meshes move beside each other in a step. A motion of
/// all together, as of cloth and the body that walks in it, brings no two of them nearer.
#pragma once

#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/surface.h"
#include "engine/model/model.h"

namespace weft {

struct ContactSpeeds {
  kernels::Vector drift{};  // m/s, that all do together; the others are beside that
  double of_cloth = 0;      // m/s: no particle is faster
  double of_bodies = 0;     // m/s: no point of any body is faster
  double of_near = 0;       // nor any of those that the cloth may come to until the step ends
};

/// When a step begins; starts: of the slots; ways: that they are to take in a substep.
ContactSpeeds speeds_of_step(const Model& model, std::span<const kernels::Vector> starts,
                             std::span<const kernels::Vector> ways,
                             std::span<const ContactSurface> bodies, const BodyClock& clock);

}  // namespace weft
