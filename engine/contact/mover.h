/// Moves particles in the end of an interval, and loads the body that has stopped them.
#pragma once

#include "engine/contact/scene.h"

namespace weft {

class Mover {
 public:
  /// body: kNoIndex where cloth stops cloth.
  Mover(const ContactScene& scene, std::uint32_t body) : scene_(scene), body_(body) {}

  /// of_surface: m/s, of the body there.
  void move(std::uint32_t slot, kernels::Vector by, kernels::Vector faster,
            kernels::Vector of_surface) const {
    ContactParticle particle = scene_.particles.read(slot);
    particle.x = particle.x + by;
    particle.v = particle.v + faster;
    scene_.particles.write(slot, particle);
    scene_.points.set_end(slot, particle.x);
    if (body_ == kNoIndex) return scene_.particles.jolt(slot, faster);
    scene_.particles.stop(slot, {body_, of_surface});
    const double momentum = scene_.model.mass[slot] * scene_.particles.momentum_share();
    scene_.impulses.add(body_, scene_.clock.motions()[body_].to.centre, particle.x,
                        momentum * faster, of_surface);
  }

 private:
  const ContactScene& scene_;
  const std::uint32_t body_;
};

}  // namespace weft
