/// Moves particles at the end of an interval, and loads the body that has stopped them.
#pragma once

#include "engine/contact/scene.h"

namespace weft {

class Mover {
 public:
  /// body: kNoIndex where cloth stops cloth.
  Mover(const ContactScene& scene, std::uint32_t body) : scene_(scene), body_(body) {}

  /// Bodies of a closed form stop particles that cloth has moved: the other feature moves by the
  /// rest. of_surface: m/s, of the body there.
  void move(std::uint32_t slot, kernels::Vector by, kernels::Vector faster,
            kernels::Vector of_surface) const {
    const kernels::Vector before = scene_.particles.read(slot).v;
    put(slot, by, faster);
    if (body_ != kNoIndex) return load(slot, faster, of_surface);
    scene_.particles.push(slot, {}, {});
    scene_.points.set_end(slot, scene_.particles.position(slot));
    scene_.particles.jump_velocity(slot, scene_.particles.read(slot).v - before);
  }
  /// Only the body stops it: all particles of a rigid zone move together.
  void move_in_zone(std::uint32_t slot, kernels::Vector by, kernels::Vector faster,
                    kernels::Vector of_surface) const {
    put(slot, by, faster);
    if (body_ != kNoIndex) return load(slot, faster, of_surface);
    scene_.particles.jump_velocity(slot, faster);
  }

 private:
  void put(std::uint32_t slot, kernels::Vector by, kernels::Vector faster) const {
    ContactParticle particle = scene_.particles.read(slot);
    particle.x = particle.x + by;
    particle.v = particle.v + faster;
    scene_.particles.write(slot, particle);
    scene_.points.set_end(slot, particle.x);
  }
  void load(std::uint32_t slot, kernels::Vector faster, kernels::Vector of_surface) const {
    scene_.particles.stop(slot, {body_, of_surface});
    const double momentum = scene_.model.mass[slot] * scene_.particles.momentum_share();
    scene_.impulses.add(body_, scene_.clock.motions()[body_].to.centre,
                        scene_.particles.position(slot), momentum * faster, of_surface);
  }

  const ContactScene& scene_;
  const std::uint32_t body_;
};

}  // namespace weft
