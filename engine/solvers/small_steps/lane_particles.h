/// Particles of small steps in lanes as contacts with meshes see them.
#pragma once

#include "engine/contact/contact_particles.h"
#include "engine/solvers/small_steps/lane_points.h"

namespace weft {

class LaneParticles final : public ContactParticles {
 public:
  explicit LaneParticles(const LanePoints& points) : points_(points) {}

  kernels::Vector position(std::uint32_t slot) const override {
    return points_.place(points_.u, slot);
  }
  kernels::Vector start(std::uint32_t slot) const override {
    return points_.place(points_.u_start, slot);
  }
  ContactParticle read(std::uint32_t slot) const override {
    return {start(slot), position(slot), points_.settled(slot)};
  }
  void write(std::uint32_t slot, const ContactParticle& particle) override {
    points_.put(slot, particle.x, particle.v);
    points_.put_start(slot, particle.start);
  }
  void touch(std::uint32_t slot, const TouchedSurface& surface) override {
    if (points_.bodies->begins_to_touch(slot)) stop(slot, surface);
  }
  void stop(std::uint32_t slot, const TouchedSurface& surface) override {
    points_.arrived.push_back({slot, surface});
  }
  double momentum_share() const override { return points_.bodies->momentum_share(); }

 private:
  const LanePoints& points_;
};

inline void LanePoints::grip(std::uint32_t slot) const {
  SimdBodies::Particle particle{place(u_start, slot), place(u, slot), settled(slot)};
  const TouchedSurface surface = bodies->hold(slot, particle);
  if (surface.is_there()) {
    put(slot, particle.x, particle.v);
    put_start(slot, particle.start);
    if (bodies->begins_to_touch(slot)) arrived.push_back({slot, surface});
  }
  if (!bodies->has_meshes()) return;
  LaneParticles particles(*this);
  bodies->hold_by_meshes(slot, particles);
}

}  // namespace weft
