/// The speeds of a cloth and of mesh bodies relative to each other in a step. A common motion, such
/// as that of a character who walks and its clothes, brings no two of them nearer.
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
