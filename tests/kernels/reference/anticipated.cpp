/// Anticipated errors (paper 4.2) against errors recomputed from positions, where the printed
/// formula would be wrong: unequal masses, constraints that meet head to head and tail to head,
/// fixed ends.
#include "kernels/reference/anticipated.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "engine/state.h"
#include "tests/support/clothes.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test {
namespace {

using reference::Relaxation;

/// 40 particles of 0.01 to 100 kg, four fixed, 100 bars and ropes between random pairs in random
/// orientation, 30 of them at a hub.
SceneDescription tangle(std::uint32_t seed) {
  Random random(seed);
  SceneDescription scene;
  for (int i = 0; i < 40; ++i) {
    scene.positions.push_back(random.in_box(1));
    scene.masses.push_back(std::pow(10, random.between(-2, 2)));
  }
  scene.fixed = {3, 11, 19, 27};
  for (std::uint32_t k = 0; k < 100; ++k) {
    // Steps of 1, 2, 3 through the particles repeat no pair; the last 30 all start at particle 0.
    std::uint32_t a = k < 70 ? k % 35 : 0;
    std::uint32_t b = k < 70 ? a + 1 + k / 35 : k - 67 + 6;
    if (random.below(2) == 1) std::swap(a, b);
    const auto kind = random.below(5) == 0 ? ConstraintKind::rope : ConstraintKind::distance;
    scene.constraints.push_back({a, b, random.between(0.2, 1.5), kind});
  }
  return scene;
}

/// What anticipation says of constraint c: its own error and what the hubs at its ends moved since.
double anticipated_error(const Relaxation& r, const reference::Topology& t,
                         const reference::Workspace& w, std::size_t c) {
  double e = w.error[c];
  if (c < r.plain) return e;
  if (t.hub[r.a[c]]) e += dot(r.n[c], w.hub_motion[r.a[c]]);
  if (t.hub[r.b[c]]) e -= dot(r.n[c], w.hub_motion[r.b[c]]);
  return e;
}

void check_anticipation(const Settings& settings, std::uint32_t seed) {
  State state(model_of(tangle(seed)), settings);
  for (std::size_t i = 0; i < state.solved.size(); ++i) state.solved.set(i, state.position[i]);
  const Relaxation r = state.position_problem(0.01);
  const reference::Topology topology = state.model->topology();
  const reference::Workspace workspace = state.workspace();
  REQUIRE(r.plain > 20);
  REQUIRE(r.bilateral - r.plain > 10);
  REQUIRE(r.count - r.bilateral > 10);
  reference::Method method;
  method.anticipate = true;
  method.skip = settings.skip;
  method.frozen_directions = true;
  method.fixed_iterations = settings.iterations;
  method.max_iterations = settings.max_iterations;
  const auto result = relax_positions(r, topology, state.contact_lists(), workspace, method);
  CHECK(result.direction_updates == 1);
  CHECK(result.corrections > 50);
  for (std::size_t c = 0; c < r.count; ++c) {
    CAPTURE(c);
    REQUIRE(std::abs(anticipated_error(r, topology, workspace, c) - error(r, c)) < 1e-12);
  }
}

TEST_CASE("anticipated errors are the true ones along the directions, for unequal masses") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Settings fixed;
    fixed.iterations = 4;
    check_anticipation(fixed, seed);

    Settings skipping = tight(1e-9);
    skipping.max_iterations = 4;
    check_anticipation(skipping, seed);

    Settings limited = fixed;
    limited.impulse_limit = 1;
    check_anticipation(limited, seed);
  }
}

// Three in a row, 0 - 1 - 2 along x, of 1, 4 and 2 kg, where the first bar is 0.2 m too long and
// the second, at an angle of 60 degrees, is at rest. Correcting the first moves particle 1 towards
// 0 by 0.2 (1/4) / (1 + 1/4) = 0.04 m, which makes the second 0.04 cos(60) = 0.02 m too long.
TEST_CASE("one correction, worked by hand") {
  for (const bool swapped : {false, true}) {
    CAPTURE(swapped);
    SceneDescription scene;
    scene.positions = {{0, 0, 0}, {1.2, 0, 0}, {1.7, std::sqrt(0.75), 0}};
    scene.masses = {1, 4, 2};
    scene.constraints = {{0, 1, 1.0}, {1, 2, 1.0}};
    if (swapped) std::swap(scene.constraints[1].a, scene.constraints[1].b);
    State state(model_of(scene), tight(0.1));
    for (std::size_t i = 0; i < 3; ++i) state.solved.set(i, state.position[i]);
    const Relaxation r = state.position_problem(0.01);
    reference::Method method;
    method.anticipate = true;
    method.frozen_directions = true;
    method.max_iterations = 1;
    const reference::Workspace workspace = state.workspace();
    const auto result = relax_positions(r, state.model->topology(), {}, workspace, method);
    CHECK(result.corrections == 1);
    CHECK(workspace.error[0] == 0);
    CHECK(workspace.error[1] == doctest::Approx(0.02).epsilon(1e-12));
    CHECK(state.solved.x[1] == doctest::Approx(1.16).epsilon(1e-14));
    CHECK(state.solved.x[0] == doctest::Approx(0.16).epsilon(1e-14));
  }
}

}  // namespace
}  // namespace weft::test
