/// Cloth::change: what is fixed, let go, or made heavier, shorter or softer while it moves.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/bending.h"
#include "tests/support/changed.h"
#include "tests/support/clothes.h"
#include "tests/support/membrane.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_changes {
namespace {

using namespace changed;

/// Some particles are to stay within 2 cm of where they are.
SceneDescription with_anchors(SceneDescription scene) {
  for (const std::uint32_t i : {30u, 31u, 100u}) {
    scene.anchors.push_back({.particle = i, .point = scene.positions[i], .max_distance = 0.02});
  }
  return scene;
}

std::vector<NamedScene> rigid_scenes() {
  return {{"woven", with_inert(scene_of("hang", 20))},
          {"two tiles", with_inert(scene_of("hang", 80))},
          {"mesh", scene_of("cape", 20)},
          {"ropes", roped_sheet(20)},
          {"hub", hub_sheet(16)},
          {"sphere", scene_of("hang_sphere", 17)}};
}
std::vector<NamedScene> soft_scenes() {
  return {{"flag", scene_of("flag", 8)},
          {"bending", with_rows(scene_of("hang", 12), 12, 1e-4)},
          {"anchors", with_anchors(scene_of("hang", 12))},
          {"cotton", with_inert(cotton_cape(16))}};
}

template <class F>
void for_all(F f) {
  for (const NamedScene& scene : rigid_scenes()) {
    for (const Settings& settings : all_solvers()) {
      if (scene.scene.positions.size() > 1000 && settings.backend == Backend::reference) continue;
      CAPTURE(scene.name);
      CAPTURE(text(settings));
      f(scene.scene, settings);
    }
  }
  for (const NamedScene& scene : soft_scenes()) {
    for (const Settings& settings : small_steps()) {
      CAPTURE(scene.name);
      CAPTURE(text(settings));
      f(scene.scene, settings);
    }
  }
}

void shift_pins(Cloth& cloth, const SceneDescription& scene, Vec3 by) {
  for (const std::uint32_t pin : scene.fixed) {
    REQUIRE(cloth.move_fixed(pin, cloth.position(pin) + by));
  }
}

Changes nothing_new(const SceneDescription& scene) {
  return {.masses = {{0, scene.masses[0]}},
          .rest_lengths = {{0, scene.constraints[0].rest_length}},
          .compliances = {{0, scene.constraints[0].compliance}}};
}

TEST_CASE("a change to what is so already changes no bit, and neither does an empty one") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings), same = cloth.clone(), empty = cloth.clone();
    for (int k = 0; k < 4; ++k) {
      for (Cloth* each : {&cloth, &same, &empty}) {
        shift_pins(*each, scene, {0.002, 0, 0.001});
        run(*each, 0.01, 2);
      }
      CHECK(same.state_hash() == cloth.state_hash());
      CHECK(empty.state_hash() == cloth.state_hash());
      const auto model = empty.model();
      REQUIRE(empty.change({}));
      CHECK(empty.model() == model);
      REQUIRE(same.change({.rest_lengths = nothing_new(scene).rest_lengths,
                           .compliances = nothing_new(scene).compliances}));
      CHECK(same.model() != model);
    }
  });
}

/// A pin, and what is in the middle of all numbers, change sides; some of the rest becomes other.
Changes some_changes(const SceneDescription& scene) {
  const auto middle = static_cast<std::uint32_t>(scene.positions.size() / 2);
  Changes changes{.fix = {middle},
                  .release = {scene.fixed[0]},
                  .masses = {{middle + 1, 1.5 * scene.masses[middle + 1]}},
                  .rest_lengths = {{1, 0.999 * scene.constraints[1].rest_length}}};
  if (!scene.bending.empty()) {
    changes.bending = {{0, 2 * scene.bending[0].compliance}};
    changes.damping = {.stretch = 1e-4, .bending = 2e-3, .motion = 0.3};
  }
  if (!scene.air.triangles.empty())
    changes.air = {.density = 1, .drag = 0.7, .lift = 0.4, .ram = 0.6};
  return changes;
}

TEST_CASE("a cloth that is changed before its first step is one of the changed description") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings);
    REQUIRE(cloth.change(some_changes(scene)));
    Cloth built = cloth_of(with(scene, some_changes(scene)), settings);
    for (int k = 0; k < 5; ++k) {
      step(cloth, 0.01);
      step(built, 0.01);
      CHECK(cloth.state_hash() == built.state_hash());
    }
  });
}

/// A particle with so many constraints that sweeps leave much of them.
bool has_hub(const SceneDescription& scene) {
  std::vector<int> constraints(scene.positions.size());
  for (const auto& c : scene.constraints) {
    ++constraints[c.a];
    ++constraints[c.b];
  }
  return std::ranges::max(constraints) > 16;
}

/// Substeps are given: automatic ones go on as long as before the change, and those of a new cloth
/// know of no load. By the implicit scheme the two have the same bits. The past of BDF2 goes on,
/// and that of a new cloth is a free flight. They are 1e-4 m apart, and ten times as far at a hub.
TEST_CASE("one that moves goes on as a new one would from where it is") {
  for_all([](const SceneDescription& scene, Settings settings) {
    const bool is_small = settings.solver == Solver::small_steps;
    if (is_small) settings.substeps = 32;
    Cloth cloth = cloth_of(scene, settings);
    bool remembers = is_small && settings.scheme != Scheme::implicit;
    for (int k = 0; k < 12; ++k) remembers |= step(cloth, 0.01).halvings > 0;
    REQUIRE(cloth.change(some_changes(scene)));
    Cloth built = cloth_of(with(scene, some_changes(scene)), settings);
    REQUIRE(built.write_positions(positions(cloth)));
    REQUIRE(built.write_velocities(velocities(cloth)));
    CHECK(built.state_hash() == cloth.state_hash());
    step(cloth, 0.01);
    step(built, 0.01);
    const double most = has_hub(scene) ? 1.2e-3 : 1.2e-4;
    CHECK(largest_distance(positions(cloth), positions(built)) <= (remembers ? most : 0));
  });
}

TEST_CASE("clones and copies of a changed cloth go on bit for bit") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings), unchanged = cloth.clone();
    shift_pins(cloth, scene, {0.001, 0, 0});
    run(cloth, 0.01, 6);
    shift_pins(cloth, scene, {0.001, 0, 0});
    REQUIRE(cloth.write_forces(std::vector<Vec3>(scene.positions.size(), {1e-5, 0, 0})));
    REQUIRE(cloth.change(some_changes(scene)));
    Cloth clone = cloth.clone();
    REQUIRE(unchanged.copy_state(cloth));
    CHECK(unchanged.model() == cloth.model());
    for (Cloth* each : {&cloth, &clone, &unchanged}) run(*each, 0.01, 3);
    CHECK(clone.state_hash() == cloth.state_hash());
    CHECK(unchanged.state_hash() == cloth.state_hash());
    Cloth before = cloth_of(scene, settings);
    CHECK_FALSE(before.copy_state(cloth));  // of a model that was built apart
  });
}

TEST_CASE("who takes over a changed cloth keeps the settings, or refuses") {
  const SceneDescription scene = scene_of("hang", 9);
  const auto model = model_of(scene);
  auto cloth = Cloth::create(model, {}), tight = Cloth::create(model, {.tolerance = 1e-4});
  auto rattle = Cloth::create(model, {.scheme = Scheme::rattle});
  REQUIRE(cloth.value().change({.compliances = {{0, 1e-3}}}));
  run(cloth.value(), 0.01, 5);
  REQUIRE(tight.value().settings().solver == Solver::yarn);
  REQUIRE(tight.value().copy_state(cloth.value()));
  CHECK(tight.value().settings().tolerance == 1e-4);
  CHECK(tight.value().settings().solver == Solver::small_steps);  // as springs demand
  CHECK(tight.value().state_hash() == cloth.value().state_hash());
  const auto refused = rattle.value().copy_state(cloth.value());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("compliance") != std::string::npos);
  CHECK(rattle.value().model() == model);
}

TEST_CASE("automatic solvers are chosen anew, by what was asked for at first") {
  Cloth cloth = cloth_of(scene_of("hang", 9), {});
  CHECK(cloth.settings().solver == Solver::small_steps);
  run(cloth, 0.01, 3);
  REQUIRE(cloth.change({.masses = {{80, 1e4}}}));
  CHECK(cloth.settings().solver == Solver::yarn);
  CHECK(step(cloth, 0.01).status == Status::converged);
  REQUIRE(cloth.change({.masses = {{80, 1. / 81}}}));
  CHECK(cloth.settings().solver == Solver::small_steps);
  CHECK(step(cloth, 0.01).status == Status::converged);
}

/// Of one particle on a spring, in the end.
double stretch_at_rest(Cloth& cloth) {
  run(cloth, 0.01, 300);
  REQUIRE(length(cloth.velocity(1)) < 1e-2);
  return -cloth.position(1).y - 1;
}

TEST_CASE("masses and compliances that change show in what hangs on a spring, and back") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, -1, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1}};
  scene.damping = {.stretch = 0.05, .bending = 0, .motion = 2};
  for (const Settings& settings : small_steps()) {
    CAPTURE(text(settings));
    Settings fine = settings;
    fine.tolerance = 1e-4;
    Cloth cloth = cloth_of(scene, fine);
    CHECK(std::abs(stretch_at_rest(cloth)) < 1e-4);
    REQUIRE(cloth.change({.compliances = {{0, 0.002}}}));
    CHECK(stretch_at_rest(cloth) == doctest::Approx(0.02).epsilon(0.01));
    REQUIRE(cloth.change({.masses = {{1, 2}}}));
    CHECK(stretch_at_rest(cloth) == doctest::Approx(0.04).epsilon(0.01));
    REQUIRE(cloth.change({.rest_lengths = {{0, 1.1}}}));
    CHECK(stretch_at_rest(cloth) == doctest::Approx(0.14).epsilon(0.01));
    REQUIRE(cloth.change({.rest_lengths = {{0, 1}}, .compliances = {{0, 0}}}));
    step(cloth, 0.01);
    CHECK(length(cloth.velocity(1)) < 0.2);  // it was 0.14 m too long, and is put right at once
    CHECK(std::abs(stretch_at_rest(cloth)) < 1e-4);
  }
}

TEST_CASE("edges that become shorter draw a sheet together without making it fast") {
  SceneDescription scene = scene_of("hang", 9);
  scene.gravity = {0, 0, 0};
  for (const Settings& settings : all_solvers()) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 0.01, 3);
    Changes shorter;
    for (std::uint32_t c = 0; c < scene.constraints.size(); ++c) {
      shorter.rest_lengths.push_back({c, 0.9 * scene.constraints[c].rest_length});
    }
    REQUIRE(cloth.change(shorter));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(max_strain(with(scene, shorter), positions(cloth)) < 0.0101);
    CHECK(cloth.energy().kinetic < 1e-4);
    CHECK(cloth.position(80).x < 0.92);
  }
}

TEST_CASE("small steps keep their past: they do not forget it and begin anew") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1}};
  for (Settings settings : small_steps()) {
    CAPTURE(text(settings));
    settings.substeps = 4;
    settings.tolerance = 1e-6;
    Cloth cloth = cloth_of(scene, settings), changed = cloth.clone(), written = cloth.clone();
    for (int k = 0; k < 50; ++k) {
      REQUIRE(changed.change({.masses = {{1, 1 + 0.1 * k}}}));  // to a pendulum that is nothing
      REQUIRE(written.write_positions(positions(written)));
      for (Cloth* each : {&cloth, &changed, &written}) step(*each, 0.01);
    }
    CHECK(largest_distance(positions(changed), positions(cloth)) < 1e-5);
    CHECK(largest_distance(positions(written), positions(cloth)) > 1e-3);
  }
}

TEST_CASE("from woven rows to quads and back small steps lose a rounding at most") {
  const SceneDescription scene = scene_of("corners", 21);
  for (const Settings& settings : small_steps()) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 0.01, 20);
    Cloth changed = cloth.clone(), written = cloth.clone();
    REQUIRE(changed.change({.compliances = {{0, 1e-6}}}));
    REQUIRE(changed.change({.compliances = {{0, 0}}}));
    REQUIRE(written.write_positions(positions(written)));
    for (Cloth* each : {&cloth, &changed, &written}) step(*each, 0.01);
    const double rounding = settings.backend == Backend::simd ? 1e-6 : 0;
    CHECK(largest_distance(positions(changed), positions(cloth)) <= rounding);
    CHECK(largest_distance(positions(written), positions(cloth)) > 1e-5);
  }
}

TEST_CASE("triangles of fabric hang by the stiffness that they were given last") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = fabric_curtain({.warp = 40, .weft = 40, .shear = 4}, 6);
    scene.damping.motion = 5;
    Cloth cloth = cloth_of(scene, on(backend, {.solver = Solver::small_steps, .threads = 1}));
    Changes softer;
    for (std::uint32_t i = 0; i < scene.membrane.size(); ++i)
      softer.membrane.push_back({i, 20, 20, 2});
    const auto stretch = [&] {
      run(cloth, 0.01, 300);
      double least = 0;
      for (const Vec3& x : positions(cloth)) least = std::min(least, x.y);
      return -least - 0.3;
    };
    const double before = stretch();
    REQUIRE(before > 1e-3);
    REQUIRE(cloth.change(softer));
    CHECK(stretch() == doctest::Approx(2 * before).epsilon(0.1));
  }
}

TEST_CASE("new damping, bending and air alone are those of the changed description, bit for bit") {
  const SceneDescription scene = cotton_cape(12);
  Changes changes{.damping = Damping{.stretch = 2e-4, .bending = 3e-3, .motion = 0.5},
                  .air = ChangedAir{.density = 1, .drag = 0.4, .lift = 0.3}};
  for (std::uint32_t i = 0; i < scene.bending.size(); i += 3)
    changes.bending.push_back({i, (1 + 0.1 * (i % 7)) * scene.bending[i].compliance});
  for (const Backend backend : kBackends) {
    const Settings settings{.solver = Solver::small_steps, .backend = backend};
    Cloth cloth = cloth_of(scene, settings), untouched = cloth.clone();
    Cloth built = cloth_of(with(scene, changes), settings), old = cloth_of(scene, settings);
    REQUIRE(cloth.change(changes));
    for (Cloth* each : {&cloth, &built, &untouched, &old}) run(*each, 0.01, 5);
    CHECK(cloth.state_hash() == built.state_hash());
    CHECK(untouched.state_hash() == old.state_hash());
  }
}

TEST_CASE("a cloth that moves loses no place, speed or energy by new damping, bending and air") {
  const SceneDescription scene = cotton_cape(12);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  run(cloth, 0.01, 20);
  const auto x = positions(cloth), v = velocities(cloth);
  Changes changes{.damping = Damping{.stretch = 1e-4, .bending = 1e-2, .motion = 20},
                  .air = ChangedAir{.density = 1.2, .drag = 0, .lift = 0}};
  for (std::uint32_t i = 0; i < scene.bending.size(); ++i)
    changes.bending.push_back({i, 0.5 * scene.bending[i].compliance});
  REQUIRE(cloth.change(changes));
  CHECK(positions(cloth).size() == x.size());
  CHECK(largest_distance(positions(cloth), x) == 0);
  CHECK(largest_distance(velocities(cloth), v) == 0);
  run(cloth, 0.01, 100);
  CHECK(cloth.energy().kinetic < 0.01);  // falls at g / 20 s^-1 at most
}

}  // namespace
}  // namespace weft::test::engine_step_changes
