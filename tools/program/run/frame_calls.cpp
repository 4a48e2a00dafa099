#include "tools/program/run/frame_calls.h"

namespace weft::tools {

FrameCalls calls_at(const MovedPins& pins, const MovedBodies& bodies, const Cloth& cloth,
                    double time) {
  return {pins.places_at(cloth, time), bodies.poses_at(time), bodies.deformed_at(time)};
}

Result<void> apply(const FrameCalls& calls, Cloth& cloth) {
  for (const auto& [particle, position] : calls.pins) {
    if (auto done = cloth.move_fixed(particle, position); !done) return done;
  }
  for (const auto& [id, pose] : calls.bodies) {
    if (auto done = cloth.move_body(id, pose); !done) return done;
  }
  for (const auto& [id, vertices] : calls.deformed) {
    if (auto done = cloth.move_body_vertices(id, vertices); !done) return done;
  }
  return {};
}

}  // namespace weft::tools
