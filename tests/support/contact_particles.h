/// Particles of a cloth for parts of its contact: places where a substep begins and ends, which
/// nothing changes.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/contact/particles.h"

namespace weft::test {

class StandingParticles final : public ContactParticles {
 public:
  std::vector<kernels::Vector> from, to;
  kernels::Vector position(std::uint32_t slot) const override { return to[slot]; }
  kernels::Vector start(std::uint32_t slot) const override { return from[slot]; }
  ContactParticle read(std::uint32_t slot) const override { return {from[slot], to[slot], {}}; }
  void write(std::uint32_t, const ContactParticle&) override {}
  void touch(std::uint32_t, const TouchedSurface&) override {}
  bool is_on_body(std::uint32_t) const override { return false; }
  void stop(std::uint32_t, const TouchedSurface&) override {}
  void jump_velocity(std::uint32_t, kernels::Vector) override {}
  void push(std::uint32_t, kernels::Vector, kernels::Vector) override {}
  bool is_beside_body(std::uint32_t) const override { return false; }
  void move_beside_bodies(std::uint32_t, kernels::Vector) override {}
  void move_to(std::uint32_t, kernels::Vector) override {}
  bool is_mended() const override { return false; }
  double momentum_share() const override { return 1; }
};

}  // namespace weft::test
