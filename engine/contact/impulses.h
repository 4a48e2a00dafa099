/// The impulses that bodies have given to the cloth.
#pragma once

#include <span>
#include <vector>

#include "engine/bodies/bodies.h"

namespace weft {

struct ContactImpulses {
  std::vector<BodyImpulse> of_body;  // per body of the clock
  double work = 0;                   // J, that bodies did
  double friction = 0;               // J, that it took

  /// An impulse at x on a surface that moves with `velocity`.
  void add(std::size_t body, kernels::Vector centre, kernels::Vector x, kernels::Vector impulse,
           kernels::Vector velocity) {
    of_body[body].linear = of_body[body].linear + impulse;
    of_body[body].angular = of_body[body].angular + cross(x - centre, impulse);
    work += dot(impulse, velocity);
  }
  void begin(std::span<const TravellingBody> bodies) {
    of_body.clear();
    for (const TravellingBody& body : bodies) of_body.push_back({.id = body.id});
    work = friction = 0;
  }
};

}  // namespace weft
