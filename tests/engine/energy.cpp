/// What take_gained_energy leaves: the energy that gravity and forces account for.
#include "engine/energy.h"

#include <doctest/doctest.h>

#include "engine/model.h"
#include "engine/scenes.h"
#include "tests/support/clothes.h"

namespace weft::test {
namespace {

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

TEST_CASE("what gravity gave stays; what came on top is taken") {
  State s = falling(0.1);
  const double fallen = kinetic(s);
  take_gained_energy(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(fallen).epsilon(1e-12));
  for (double& v : s.next_velocity.y) v *= 3;
  take_gained_energy(s, 0.1);
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
  take_gained_energy(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(given).epsilon(1e-12));
  for (double& v : s.next_velocity.y) v *= 1 + 1e-9;
  take_gained_energy(s, 0.1);
  CHECK(kinetic(s) == doctest::Approx(given).epsilon(1e-12));
}

TEST_CASE("energy that was lost is not given back") {
  State s = falling(0.1);
  for (double& v : s.next_velocity.y) v *= 0.5;
  const double before = kinetic(s);
  take_gained_energy(s, 0.1);
  CHECK(kinetic(s) == before);
}

TEST_CASE("what was lifted without work comes to rest, and no further") {
  State s = falling(0.1);
  for (double& y : s.solved.y) y += 1;
  take_gained_energy(s, 0.1);
  CHECK(kinetic(s) == 0);
}

}  // namespace
}  // namespace weft::test
