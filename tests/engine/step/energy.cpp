/// The guard of energy: what take_energy leaves of a substep.
#include "engine/step/energy.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/model/model.h"
#include "engine/step/motion.h"
#include "tests/support/clothes.h"
#include "tools/scenes/scenes.h"

namespace weft::test::engine_step_energy {
namespace {

using kernels::Vector;

constexpr double kGravity = 10;

/// Free fall for a moment, all of it in the state's two ends.
State falling(double h) {
  SceneDescription scene = scene_of("hang", 4);
  State s(std::make_shared<const Model>(scene), Settings{});
  s.solved = s.position;
  s.next_velocity = s.velocity;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    s.solved.y[slot] -= kGravity * h * h / 2;
    s.next_velocity.y[slot] = -kGravity * h;
  }
  return s;
}

double kinetic(const State& s) {
  double sum = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w > 0) sum += dot(s.next_velocity[slot], s.next_velocity[slot]) / (2 * w);
  }
  return sum;
}

/// Of the substep that is in the state.
kernels::ImpulseEnergy change_of(const State& s) {
  kernels::ImpulseEnergy change;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    const Vector a = acceleration(s, slot), v = s.velocity[slot], next = s.next_velocity[slot];
    const Vector moved = s.solved[slot] - s.position[slot];
    change.gain += (dot(next, next) - dot(v, v) - 2 * dot(a, moved)) / w;
    change.energy += dot(next, next) / w;
  }
  return change;
}

bool guard(State& s, double h) {
  kernels::ImpulseEnergy change = change_of(s);
  return take_energy(s, gained_energy(s, change, h), h, change);
}

TEST_CASE("what gravity gave stays; what came on top is taken") {
  State s = falling(0.1);
  const double fallen = kinetic(s);
  guard(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(fallen).epsilon(1e-12));
  for (double& v : s.next_velocity.y) v *= 3;
  guard(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(fallen).epsilon(1e-12));
}

TEST_CASE("what a force gave stays, and of a little on top nothing") {
  State s = falling(0.1);
  s.force = kernels::Vectors(s.model->slots());
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    s.force.y[slot] = -kGravity / w;
    s.solved.y[slot] -= kGravity * 0.1 * 0.1 / 2;
    s.next_velocity.y[slot] *= 2;
  }
  const double given = kinetic(s);
  guard(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(given).epsilon(1e-12));
  for (double& v : s.next_velocity.y) v *= 1 + 1e-9;
  guard(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(given).epsilon(1e-12));
}

TEST_CASE("energy that was lost is not given back") {
  State s = falling(0.1);
  for (double& v : s.next_velocity.y) v *= 0.5;
  const double before = kinetic(s);
  guard(s, 0.1);
  CHECK(kinetic(s) == before);
}

TEST_CASE("what was lifted without work comes to rest, and no further") {
  State s = falling(0.1);
  for (double& y : s.solved.y) y += 1;
  CHECK_FALSE(guard(s, 0.1));
  CHECK(kinetic(s) == 0);
}

/// Changes s to the same state in a frame in which this one moves at `speed`.
void see_from(State& s, Vector speed, double h) {
  s.pins.watch(*s.model, s.position);
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (!s.model->is_particle(slot)) continue;
    s.solved.set(slot, s.solved[slot] + h * speed);
    s.velocity.set(slot, s.velocity[slot] + speed);
    s.next_velocity.set(slot, s.next_velocity[slot] + speed);
  }
}

TEST_CASE("what is taken does not depend on who looks on") {
  const double h = 0.1;
  const Vector speed{3, -20, 40};
  State s = falling(h), moving = falling(h);
  for (State* each : {&s, &moving}) {
    for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
      if (s.model->inverse_mass[slot] == 0) continue;
      const double k = slot;
      each->next_velocity.set(slot, {k, 2 - k, 3});
    }
  }
  see_from(moving, speed, h);
  const double before = kinetic(s);
  guard(s, h);
  guard(moving, h);
  CHECK(kinetic(s) > 0);
  CHECK(kinetic(s) < before / 2);
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (!s.model->is_particle(slot)) continue;
    CHECK(length(moving.next_velocity[slot] - s.next_velocity[slot] - speed) < 1e-10);
  }
}

/// As the paper's scheme makes them of the positions.
void set_velocities(State& s, double h) {
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    const Vector moved = s.solved[slot] - s.position[slot];
    s.next_velocity.set(slot, (1 / h) * moved + (h / 2) * acceleration(s, slot));
  }
}

TEST_CASE("a kick that turned into speed is taken, one that stopped something is not given back") {
  const double h = 0.1;
  State s = falling(h);
  s.gravity = {};
  s.next_velocity = s.velocity;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    s.solved.set(slot, s.position[slot]);
    if (s.model->inverse_mass[slot] > 0) s.solved.z[slot] += 0.01;
  }
  set_velocities(s, h);
  REQUIRE(kinetic(s) > 0);
  guard(s, h);
  CHECK(kinetic(s) == 0);
  set_velocities(s, h);
  std::swap(s.velocity, s.next_velocity);
  CHECK(guard(s, h));
  CHECK(kinetic(s) == 0);
}

/// A sheet at rest that a substep takes along with its pins, or some of them.
State taken_along(Vector speed, std::size_t pins, double h) {
  const SceneDescription scene = scene_of("hang", 4);
  State s(std::make_shared<const Model>(scene), Settings{});
  s.gravity = {};
  s.solved = s.position;
  s.next_velocity = s.velocity;
  if (pins > 0) s.pins.watch(*s.model, s.position);
  for (std::size_t k = 0; k < pins; ++k) {
    s.velocity.set(s.model->ordering.slot_of[scene.fixed[k]], speed);
  }
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] > 0) s.solved.set(slot, s.position[slot] + h * speed);
  }
  set_velocities(s, h);
  return s;
}

TEST_CASE("motion that pins brought is no gain") {
  const Vector speed{1, 2, 3};
  const std::size_t pins = scene_of("hang", 4).fixed.size();
  State left = taken_along(speed, 0, 0.1);
  guard(left, 0.1);
  CHECK(kinetic(left) == 0);
  State s = taken_along(speed, pins, 0.1);
  guard(s, 0.1);
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    CHECK(length(s.next_velocity[slot] - speed) < 1e-12);
  }
}

TEST_CASE("what springs have released stays, and no more") {
  const double h = 0.1, released = 3;
  State s = falling(h);
  const double fallen = kinetic(s);
  for (const double share : {0.9, 1.0, 1.3}) {
    s = falling(h);
    for (double& v : s.next_velocity.y) v *= std::sqrt(1 + share * released / fallen);
    kernels::ImpulseEnergy change = change_of(s);
    s.lost_energy = guard_springs(s, s.lost_energy, released, h, change);
    CHECK(kinetic(s) - fallen == doctest::Approx(std::min(share, 1.0) * released).epsilon(1e-12));
    CHECK(s.lost_energy == doctest::Approx(std::max(0.0, 1 - share) * released).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace weft::test::engine_step_energy
