/// Particles of small steps as contacts with meshes see them, in lanes and in double.
#pragma once

#include <utility>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/contact/particles.h"
#include "engine/solvers/small_steps/particle_at_hand.h"

namespace weft {

/// Each is read and written where it stands. Points: LanePoints, or ReferenceStore::Points.
template <class Points>
class PointParticles : public ContactParticles {
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
    ParticleAtHand hand = points_.take(slot);
    hand.stop(particle);
    points_.put_back(slot, hand);
  }
  void touch(std::uint32_t slot, const TouchedSurface& surface) override {
    if (points_.bodies->begins_to_touch(slot)) stop(slot, surface);
  }
  bool is_on_body(std::uint32_t slot) const override { return points_.bodies->touches(slot); }
  void stop(std::uint32_t slot, const TouchedSurface& surface) override {
    points_.arrived.push_back({slot, surface});
  }
  void jump_velocity(std::uint32_t slot, kernels::Vector by) override {
    points_.velocity_jumps.push_back({slot, by});
  }
  void push(std::uint32_t slot, kernels::Vector by, kernels::Vector comes_out) override {
    ParticleAtHand hand = points_.take(slot);
    push(slot, hand, by, comes_out);
    points_.put_back(slot, hand);
  }
  bool is_beside_body(std::uint32_t slot) const override {
    return points_.bodies->is_beside(slot, start(slot), position(slot));
  }
  void move_to(std::uint32_t slot, kernels::Vector x) override { points_.move_to(slot, x); }
  void move_beside_bodies(std::uint32_t slot, kernels::Vector x) override {
    ParticleAtHand hand = points_.take(slot);
    follow(slot, hand, x);
    points_.put_back(slot, hand);
  }
  bool is_mended() const override { return points_.is_mended(); }
  double momentum_share() const override { return points_.bodies->momentum_share(); }

 protected:
  void follow(std::uint32_t slot, ParticleAtHand& hand, kernels::Vector x) const {
    hand.shift({}, x - hand.x);
    hand.clear = 0;
    ContactParticle at{hand.start, hand.x, hand.settled(points_.rate)};
    const TouchedSurface surface = points_.bodies->follow(slot, at);
    if (!surface.is_there()) return;
    hand.stop(at);
    hand.clear = 0;
    if (points_.bodies->begins_to_touch(slot)) points_.arrived.push_back({slot, surface});
  }
  void push(std::uint32_t slot, ParticleAtHand& hand, kernels::Vector by,
            kernels::Vector comes_out) const {
    const bool stays = dot(comes_out, comes_out) == 0;  // mostly
    const kernels::Vector kept =
        stays ? comes_out : points_.bodies->kept_out(slot, hand.start, comes_out);
    hand.shift(kept, by + kept);
    hold_by_bodies(points_, slot, hand);
  }
  const Points& points_;
};

/// Memory for particles that a sweep has at hand.
struct ParticlesAtHand {
  std::vector<ParticleAtHand> of;  // per slot
  enum class State : std::uint8_t { elsewhere, taken, moved };
  std::vector<State> state;          // likewise
  std::vector<std::uint32_t> slots;  // that are not elsewhere

  void make_room(std::size_t count) {
    of.resize(count);
    state.resize(count, State::elsewhere);
    slots.reserve(count);
  }
  std::size_t bytes() const { return bytes_of(of) + bytes_of(state) + bytes_of(slots); }
};

/// A sweep visits a particle many times: it is taken when more than its position is asked for, and
/// put back when the sweep ends.
template <class Points>
class TakenParticles final : public PointParticles<Points> {
 public:
  TakenParticles(const Points& points, ParticlesAtHand& at_hand)
      : PointParticles<Points>(points), at_hand_(at_hand) {}
  TakenParticles(const TakenParticles&) = delete;
  TakenParticles& operator=(const TakenParticles&) = delete;
  ~TakenParticles() override {
    for (const std::uint32_t slot : at_hand_.slots) {
      const State was = std::exchange(at_hand_.state[slot], State::elsewhere);
      if (was == State::moved) points().put_back(slot, at_hand_.of[slot]);
    }
    at_hand_.slots.clear();
  }

  kernels::Vector position(std::uint32_t slot) const override {
    return at_hand_.state[slot] == State::elsewhere ? points().position(slot) : at_hand_.of[slot].x;
  }
  kernels::Vector start(std::uint32_t slot) const override { return hand(slot).start; }
  ContactParticle read(std::uint32_t slot) const override {
    const ParticleAtHand& at = hand(slot);
    return {at.start, at.x, at.settled(points().rate)};
  }
  void write(std::uint32_t slot, const ContactParticle& particle) override {
    moving(slot).stop(particle);
  }
  void push(std::uint32_t slot, kernels::Vector by, kernels::Vector comes_out) override {
    PointParticles<Points>::push(slot, moving(slot), by, comes_out);
  }
  void move_beside_bodies(std::uint32_t slot, kernels::Vector x) override {
    PointParticles<Points>::follow(slot, moving(slot), x);
  }
  void move_to(std::uint32_t slot, kernels::Vector x) override {
    if (at_hand_.state[slot] == State::elsewhere) return points().move_to(slot, x);
    ParticleAtHand& particle = moving(slot);
    particle.shift({}, x - particle.x);
  }

 private:
  using State = ParticlesAtHand::State;
  const Points& points() const { return this->points_; }
  ParticleAtHand& hand(std::uint32_t slot) const {
    if (at_hand_.state[slot] == State::elsewhere) {
      at_hand_.of[slot] = points().take(slot);
      at_hand_.state[slot] = State::taken;
      at_hand_.slots.push_back(slot);
    }
    return at_hand_.of[slot];
  }
  ParticleAtHand& moving(std::uint32_t slot) const {
    ParticleAtHand& particle = hand(slot);
    at_hand_.state[slot] = State::moved;
    return particle;
  }
  ParticlesAtHand& at_hand_;
};

}  // namespace weft
