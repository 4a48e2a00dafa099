/// The solver and the scheme that stand for `automatic`.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_cpp_interface_automatic {
namespace {

Solver chosen(const SceneDescription& scene, const Settings& settings) {
  return cloth_of(scene, settings).settings().solver;
}

TEST_CASE("automatic is small steps for cloth, where these are said to be the fastest") {
  for (const char* name : {"hang", "hang_sphere", "corners", "banner", "four_pins", "cape"}) {
    CAPTURE(std::string(name));
    const SceneDescription scene = scene_of(name, 9);
    for (const Scheme scheme : {Scheme::automatic, Scheme::bdf2, Scheme::implicit}) {
      const Cloth cloth = cloth_of(scene, {.scheme = scheme});
      CHECK(cloth.settings().solver == Solver::small_steps);
      CHECK(cloth.settings().scheme == (scheme == Scheme::automatic ? Scheme::bdf2 : scheme));
    }
    CHECK(chosen(scene, {.tolerance = 1e-3}) == Solver::small_steps);
    CHECK(chosen(scene, {.tolerance = 0.9e-3}) == Solver::yarn);
    CHECK(chosen(scene, {.substeps = 4}) == Solver::small_steps);
    CHECK(chosen(scene, {.scheme = Scheme::paper}) == Solver::yarn);
    CHECK(chosen(scene, {.scheme = Scheme::rattle}) == Solver::yarn);
    CHECK(chosen(scene, {.velocity_correction = true}) == Solver::yarn);
    CHECK(chosen(scene, {.iterations = 3}) == Solver::gauss_seidel);
    CHECK(chosen(scene, {.backend = Backend::reference}) == Solver::gauss_seidel);
  }
  CHECK(chosen(scene_of("sphere_drop", 9), {}) == Solver::yarn);
  CHECK(chosen(scene_of("chain", 9), {}) == Solver::small_steps);
  CHECK(chosen(scene_of("chain", 9), {.tolerance = 0.9e-3}) == Solver::yarn);
  SceneDescription uneven = scene_of("hang", 9);
  uneven.masses.back() *= 99;
  CHECK(chosen(uneven, {}) == Solver::small_steps);
  uneven.masses.back() *= 2;
  CHECK(chosen(uneven, {}) == Solver::yarn);
  SceneDescription ropes = scene_of("hang", 9);
  for (Constraint& c : ropes.constraints) c.kind = ConstraintKind::rope;
  CHECK(chosen(ropes, {}) == Solver::small_steps);
}

TEST_CASE("what automatic is by scheme: paper unless small steps are chosen") {
  const SceneDescription scene = scene_of("hang", 9);
  const auto scheme = [&](const Settings& settings) {
    return cloth_of(scene, settings).settings().scheme;
  };
  CHECK(scheme({.solver = Solver::small_steps}) == Scheme::bdf2);
  CHECK(scheme({.solver = Solver::small_steps, .scheme = Scheme::implicit}) == Scheme::implicit);
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn}) {
    CHECK(scheme({.solver = solver}) == Scheme::paper);
  }
  CHECK(scheme({.tolerance = 1e-4}) == Scheme::paper);
  CHECK(scheme({.scheme = Scheme::rattle}) == Scheme::rattle);
}

TEST_CASE("the solver that automatic stands for: another than yarns where they have no chance") {
  const SceneDescription hang = scene_of("hang", 4), sphere = scene_of("hang_sphere", 4);
  const Settings paper{.scheme = Scheme::paper}, rattle{.scheme = Scheme::rattle};
  for (const Settings& settings : {paper, rattle}) {
    CHECK(chosen(hang, settings) == Solver::yarn);
    CHECK(chosen(sphere, settings) == Solver::yarn);
  }
  CHECK(chosen(hang, {.iterations = 3}) == Solver::gauss_seidel);
  CHECK(chosen(hang, {.backend = Backend::reference}) == Solver::gauss_seidel);
  CHECK(cloth_of(hang, {.backend = Backend::reference}).settings().substeps == 1);
  SceneDescription heavy = scene_of("chain", 4);
  for (const double ratio : {9e3, 2e4, 2e6}) {
    heavy.masses.back() = ratio * heavy.masses[1];
    CHECK(chosen(heavy, {}) == Solver::small_steps);
    CHECK(chosen(heavy, {.substeps = 2}) == Solver::small_steps);
    CHECK(chosen(heavy, {.tolerance = 1e-6}) == Solver::small_steps);
    CHECK(chosen(heavy, paper) == Solver::yarn);
  }
  heavy.constraints.back().kind = ConstraintKind::rope;
  CHECK(chosen(heavy, paper) == Solver::direct);
  SceneDescription net = scene_of("hang", 33);
  for (std::size_t c = 0; c < net.constraints.size(); ++c) {
    if (c % 5 > 0) net.constraints[c].kind = ConstraintKind::rope;
  }
  CHECK(chosen(net, paper) == Solver::yarn);
  for (std::size_t c = 0; c < net.constraints.size(); c += 5) {
    if (c > 200) net.constraints[c].kind = ConstraintKind::rope;
  }
  CHECK(chosen(net, paper) == Solver::yarn);
  net.masses.back() = 2e4 * net.masses[20];
  CHECK(chosen(net, paper) == Solver::yarn);
}

/// Ropes in a row, the first particle fixed, from a plumb line by 0.3 rad.
SceneDescription cord(std::uint32_t ropes, double length) {
  SceneDescription scene;
  const Vec3 along{std::sin(0.3) * length / ropes, -std::cos(0.3) * length / ropes, 0};
  for (std::uint32_t i = 0; i <= ropes; ++i) {
    scene.positions.push_back({along.x * i, along.y * i, 0});
    if (i > 0) scene.constraints.push_back({i - 1, i, length / ropes, ConstraintKind::rope});
  }
  scene.masses.assign(ropes + 1, 1);
  scene.fixed = {0};
  return scene;
}

TEST_CASE(
    "automatic: chains of ropes are for small steps, and those with heavy spheres for direct") {
  CHECK(chosen(cord(1, 2), {}) == Solver::small_steps);
  CHECK(chosen(cord(40, 1.1), {}) == Solver::small_steps);
  CHECK(chosen(cord(40, 0.9), {.tolerance = 1e-6}) == Solver::small_steps);
  CHECK(chosen(cord(40, 0.9), {.scheme = Scheme::paper}) == Solver::direct);
  SceneDescription loaded = cord(40, 0.9);
  loaded.masses.back() = 200;
  CHECK(chosen(loaded, {}) == Solver::small_steps);
  SceneDescription bridge = cord(40, 2);  // of two cords
  const SceneDescription other = cord(40, 2);
  bridge.positions.insert(bridge.positions.end(), other.positions.begin(), other.positions.end());
  bridge.masses.assign(82, 1);
  for (const Constraint& c : other.constraints) {
    bridge.constraints.push_back({c.a + 41, c.b + 41, c.rest_length, c.kind});
  }
  for (std::uint32_t i = 0; i <= 40; ++i) {
    bridge.positions[i + 41].z = 1;
    bridge.constraints.push_back({i, i + 41, 1});
  }
  CHECK(chosen(bridge, {}) == Solver::small_steps);
  SceneDescription net = scene_of("hang", 20);
  for (Constraint& c : net.constraints) c.kind = ConstraintKind::rope;
  CHECK(chosen(net, {.scheme = Scheme::paper}) == Solver::yarn);
  SceneDescription beads = cord(17, 2);
  beads.radii.assign(18, 0.01);
  for (std::uint32_t i = 0; i <= 16; ++i) beads.spheres.push_back(i);  // the first one is fixed
  CHECK(chosen(beads, {}) == Solver::small_steps);
  beads.masses.back() = beads.masses[16] = 200;
  CHECK(chosen(beads, {}) == Solver::direct);
  beads.spheres.push_back(17);
  CHECK(chosen(beads, {}) == Solver::yarn);
}

TEST_CASE("automatic: a weight on a cord swings, and gains no energy, however short the steps") {
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    for (const std::uint32_t ropes : {1u, 8u}) {
      for (const double dt : {1 / 60., 1 / 240.}) {
        CAPTURE(dt);
        Cloth cloth = cloth_of(cord(ropes, 2), {.scheme = scheme});
        const double start = cloth.energy().total();
        double most = start, fastest = 0;
        for (double t = 0; t < 2; t += dt) {
          REQUIRE(cloth.step(dt).value().status == Status::converged);
          most = std::max(most, cloth.energy().total());
          fastest = std::max(fastest, cloth.energy().kinetic);
        }
        CHECK(most - start < 0.02 * fastest);
        CHECK(fastest > 0.7 * ropes / 2.);
      }
    }
  }
}

TEST_CASE("automatic: particles that nothing joins have no say in it") {
  SceneDescription braced = scene_of("hang", 20);
  for (std::uint32_t i = 0; i < 399; ++i) {
    const bool diagonal = i % 20 < 19 && i < 380;
    if (diagonal) {
      braced.constraints.push_back({i, i + 21, 0.06 * std::sqrt(2.), ConstraintKind::rope});
    }
  }
  for (const SceneDescription& scene : {braced, scene_of("hang", 20), cord(40, 2)}) {
    const Solver alone = cloth_of(scene, {}).settings().solver;
    SceneDescription beside = scene;
    beside.positions.resize(scene.positions.size() + 1000);
    beside.masses.resize(beside.positions.size(), 1);
    CHECK(cloth_of(beside, {}).settings().solver == alone);
  }
}

}  // namespace
}  // namespace weft::test::engine_cpp_interface_automatic
