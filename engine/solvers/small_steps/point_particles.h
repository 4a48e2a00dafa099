/// Particles of small steps as contacts with meshes see them, in lanes and in double.
#pragma once

#include "engine/contact/particles.h"

namespace weft {

/// Points: LanePoints, or ReferenceStore::Points.
template <class Points>
class PointParticles final : public ContactParticles {
 public:
  explicit PointParticles(const Points& points) : points_(points) {}

  kernels::Vector position(std::uint32_t slot) const override { return points_.position(slot); }
  kernels::Vector start(std::uint32_t slot) const override {
    return points_.position_at_start(slot);
  }
  ContactParticle read(std::uint32_t slot) const override {
    return {start(slot), position(slot), points_.settled(slot)};
  }
  void write(std::uint32_t slot, const ContactParticle& particle) override {
    points_.put(slot, particle.x, particle.v);
    points_.put_start(slot, particle.start);
  }
  void move_to(std::uint32_t slot, kernels::Vector x, kernels::Vector v) override {
    points_.put(slot, x, v);
  }
  void touch(std::uint32_t slot, const TouchedSurface& surface) override {
    if (points_.bodies->begins_to_touch(slot)) stop(slot, surface);
  }
  bool is_on_body(std::uint32_t slot) const override { return points_.bodies->touches(slot); }
  void stop(std::uint32_t slot, const TouchedSurface& surface) override {
    points_.arrived.push_back({slot, surface});
  }
  void jolt(std::uint32_t slot, kernels::Vector by) override {
    points_.jolts.push_back({slot, by});
  }
  void push(std::uint32_t slot, kernels::Vector by, kernels::Vector comes_out) override {
    const bool stays = dot(comes_out, comes_out) == 0;  // mostly
    const kernels::Vector kept =
        stays ? comes_out : points_.bodies->kept_out(slot, start(slot), comes_out);
    points_.shift(slot, kept, by + kept);
    points_.grip_by_bodies(slot);
  }
  bool is_mended() const override { return points_.is_mended(); }
  double momentum_share() const override { return points_.bodies->momentum_share(); }

 private:
  const Points& points_;
};

}  // namespace weft
