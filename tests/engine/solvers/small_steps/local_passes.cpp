/// Passes over what is out of tolerance alone.
#include "engine/solvers/small_steps/local_passes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "tests/support/clothes.h"

namespace weft::test::engine_solvers_small_steps_local_passes {
namespace {

struct Points {
  kernels::Vectors x;
  std::set<std::uint32_t> moved = {};

  kernels::Vector difference(std::uint32_t a, std::uint32_t b) const { return x[a] - x[b]; }
  void move(std::uint32_t slot, kernels::Vector by) {
    x.view().add(slot, by);
    moved.insert(slot);
  }
  void push(std::uint32_t slot, kernels::Vector by) { move(slot, by); }
  // Of springs and triangles of fabric, which none of these models has.
  double multiplier(std::uint32_t) const { return 0; }
  void set_multiplier(std::uint32_t, double) {}
  reference::MembraneMultipliers membrane_multipliers(std::uint32_t) const { return {}; }
  void set_membrane_multipliers(std::uint32_t, const reference::MembraneMultipliers&) {}
  kernels::Vector start_difference(std::uint32_t a, std::uint32_t b) const {
    return difference(a, b);
  }
};

constexpr LocalLimits kLimits{
    .tolerance = 0.01, .contact_tolerance = 1e-4, .mended = 0.008, .most_visits = 1'000'000};

double largest_strain(const Model& model, const Points& points) {
  double largest = 0;
  for (std::uint32_t c = 0; c < model.constraints.size(); ++c) {
    largest = std::max(largest, strain_of(model, points.x, c));
  }
  return largest;
}

TEST_CASE(
    "one particle out of place is put right, and nobody else is looked at but its neighbours") {
  const auto model = model_of(scene_of("hang", 30));
  LocalPasses passes(*model, model->small_steps().items);
  Points points{model->initial_position};
  const std::uint32_t slot = model->ordering.slot_of[15 * 30 + 15];
  points.x.set(slot, points.x[slot] + kernels::Vector{0.002, 0, 0});
  std::uint32_t constraint = 0;
  const ConstraintStore& store = model->constraints;
  while (store.a[constraint] != slot && store.b[constraint] != slot) ++constraint;
  passes.look_near(constraint);
  const LocalWork work = passes.run(points, {}, kLimits);
  CHECK(work.done);
  CHECK(work.corrections > 0);
  CHECK(work.visits < 100);
  CHECK(points.moved.size() < 12);
  CHECK(largest_strain(*model, points) <= kLimits.tolerance);
}

TEST_CASE("nothing is done where nothing is out of tolerance, and nothing that nobody asked for") {
  const auto model = model_of(scene_of("corners", 9));
  LocalPasses passes(*model, model->small_steps().items);
  Points points{model->initial_position};
  CHECK(passes.run(points, {}, kLimits).visits == 0);
  passes.look_everywhere();
  const LocalWork work = passes.run(points, {}, kLimits);
  CHECK(work.visits == static_cast<std::int64_t>(model->constraints.size()));
  CHECK(work.corrections == 0);
}

TEST_CASE("the bound on visits holds, and what is left of one run does not leak into the next") {
  const auto model = model_of(scene_of("hang", 20));
  LocalPasses passes(*model, model->small_steps().items);
  Points points{model->initial_position};
  for (std::size_t i = 0; i < points.x.size(); ++i) points.x.x[i] *= 1.3;
  passes.look_everywhere();
  LocalLimits limits = kLimits;
  limits.most_visits = 1000;
  const LocalWork work = passes.run(points, {}, limits);
  CHECK_FALSE(work.done);
  CHECK(work.visits < 1000 + 2 * static_cast<std::int64_t>(model->constraints.size()));
  CHECK(passes.run(points, {}, kLimits).visits == 0);
  passes.look_everywhere();
  CHECK(passes.run(points, {}, kLimits).done);
  CHECK(largest_strain(*model, points) <= kLimits.tolerance);
}

/// Two hubs that are joined to each other and to `spokes` particles each.
SceneDescription two_hubs(std::uint32_t spokes) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {3, 0, 0}};
  scene.constraints = {{0, 1, 3}};
  for (std::uint32_t k = 0; k < 2 * spokes; ++k) {
    const double angle = 0.1 * k, x = k < spokes ? 0 : 3;
    scene.positions.push_back({x, std::cos(angle), std::sin(angle)});
    scene.constraints.push_back({k < spokes ? 0u : 1u, k + 2, 1});
  }
  scene.masses.assign(scene.positions.size(), 1);
  return scene;
}

TEST_CASE("particles of more constraints than a mask has bits are no exception") {
  const auto model = model_of(two_hubs(100));
  LocalPasses passes(*model, model->small_steps().items);
  Points points{model->initial_position};
  const std::uint32_t hub = model->ordering.slot_of[0];
  points.x.set(hub, points.x[hub] + kernels::Vector{0.2, 0, 0});
  passes.look_everywhere();
  CHECK(passes.run(points, {}, kLimits).done);
  CHECK(largest_strain(*model, points) <= kLimits.tolerance);
}

TEST_CASE("what is fixed stays, and ropes push nothing apart") {
  SceneDescription scene = free_rope(0.5);
  scene.fixed = {0};
  scene.velocities.clear();
  scene.positions.push_back({-2, 0, 0});
  scene.masses.push_back(1);
  scene.constraints.push_back({0, 2, 1, ConstraintKind::rope});
  const auto model = model_of(scene);
  LocalPasses passes(*model, model->small_steps().items);
  Points points{model->initial_position};
  passes.look_everywhere();
  CHECK(passes.run(points, {}, kLimits).done);
  const auto of = [&](std::uint32_t particle) {
    return points.x[model->ordering.slot_of[particle]];
  };
  CHECK(of(0).x == model->initial_position[model->ordering.slot_of[0]].x);
  CHECK(of(1).x == model->initial_position[model->ordering.slot_of[1]].x);
  CHECK(of(2).x >= of(0).x - 1.01);
  CHECK(of(2).x <= of(0).x - 0.99);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_local_passes
