/// Seams that draw two particles together: how fast, with which force, and what holds then.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <weft/mesh.h>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_seams {
namespace {

constexpr double kFrame = 1. / 60;

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// Two particles of 1 and 2 kg, 0.6 m apart, without gravity.
SceneDescription two_particles(const Seam& seam) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.6, 0, 0}};
  scene.masses = {1, 2};
  scene.gravity = {0, 0, 0};
  scene.seams = {seam};
  return scene;
}

double gap(const Cloth& cloth) { return distance(cloth.position(0), cloth.position(1)); }

TEST_CASE("a seam closes in its time, evenly, where both masses say, and holds") {
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(two_particles({0, 1, 0.5}), small_steps(backend));
    for (int frame = 1; frame <= 28; ++frame) {
      const StepReport report = step(cloth, kFrame);
      CHECK(report.status == Status::converged);
      CHECK(report.open_seams == 1);
      CHECK(gap(cloth) == doctest::Approx(0.6 * (1 - 2 * kFrame * frame)).epsilon(0.02));
    }
    run(cloth, kFrame, 4);
    const StepReport report = step(cloth, kFrame);
    CHECK(report.open_seams == 0);
    CHECK(report.max_seam_gap <= 1e-4);
    CHECK(distance(cloth.position(0), {0.4, 0, 0}) < 1e-3);
    CHECK(length(cloth.velocity(0)) < 0.01);
    REQUIRE(cloth.write_forces(std::vector<Vec3>{{0, 0, 0}, {0, 300, 0}}));
    for (int frame = 0; frame < 30; ++frame) CHECK(step(cloth, kFrame).max_seam_gap <= 1e-4);
    CHECK(cloth.velocity(0).y == doctest::Approx(50).epsilon(0.01));
  }
}

TEST_CASE("a seam pulls no harder than it may, and is late rather than fast") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = two_particles({0, 1, 0.1, 0.5});  // at 6 m/s
    scene.fixed = {0};
    Cloth cloth = cloth_of(scene, small_steps(backend));
    for (int frame = 1; frame <= 60; ++frame) {
      const StepReport report = step(cloth, kFrame);
      const double t = kFrame * frame, way = 0.5 * 0.25 * t * t;  // 0.5 N on 2 kg
      CHECK(gap(cloth) == doctest::Approx(0.6 - way).epsilon(0.01));
      CHECK(report.seam_work >= 0);
    }
    CHECK(length(cloth.velocity(1)) == doctest::Approx(0.25).epsilon(0.02));
    CHECK(std::abs(cloth.energy().kinetic - 0.0625) < 0.005);
  }
}

/// Two panels of cotton, 0.5 m x 0.6 m, `apart` m from each other, sewn along three edges.
SceneDescription panels(double apart, double time) {
  const auto panel = [](double z) {
    return sheet(
        13, 13,
        [z](double row, double column) {
          return Vec3{column / 24, -row / 20, z};
        },
        [](std::uint32_t row, std::uint32_t column) {
          return (row + column) % 2 == 0 ? Cut::first : Cut::second;
        });
  };
  MeshDescription mesh = panel(apart / 2), other = panel(-apart / 2);
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const std::uint32_t corner : other.corners) mesh.corners.push_back(corner + count);
  mesh.face_sizes.insert(mesh.face_sizes.end(), other.face_sizes.begin(), other.face_sizes.end());
  for (std::uint32_t row = 0; row < 13; ++row) {
    mesh.seams.push_back({13 * row, count + 13 * row});
    mesh.seams.push_back({13 * row + 12, count + 13 * row + 12});
  }
  for (const std::uint32_t column : {1u, 2u, 3u, 9u, 10u, 11u})
    mesh.seams.push_back({column, count + column});
  mesh.seam_time = time;
  mesh.material = find_material("cotton").value();
  mesh.pins = {0, 12};
  return made(mesh).scene;
}

TEST_CASE("panels that begin apart come together in the time that was asked for, and gently") {
  for (const double apart : {0.01, 0.1, 0.3}) {
    const SceneDescription scene = panels(apart, 1);
    REQUIRE(scene.seams.size() == 32);
    Cloth cloth = cloth_of(scene, {.threads = 1});
    double fastest = 0;
    for (int frame = 0; frame < 75; ++frame) {
      const StepReport report = step(cloth, kFrame);
      CAPTURE(apart);
      CAPTURE(frame);
      CHECK(report.status == Status::converged);
      if (frame > 65) CHECK(report.open_seams == 0);
      for (const Seam& seam : scene.seams)
        fastest = std::max(fastest, length(cloth.velocity(seam.b)));
    }
    CHECK(fastest <= 2 * apart + 0.2);  // gravity lets the panels sag and swing besides
    for (const Seam& seam : scene.seams)
      CHECK(distance(cloth.position(seam.a), cloth.position(seam.b)) <= 1e-4);
  }
}

TEST_CASE("a clone, a copied state and a change go on with seams as they are") {
  SceneDescription scene = two_particles({0, 1, 0.5});
  scene.constraints = {};
  Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
  run(cloth, kFrame, 10);
  Cloth clone = cloth.clone(), changed = cloth.clone();
  REQUIRE(changed.change({.masses = {{0, 1.}}}));
  for (Cloth* each : {&cloth, &clone, &changed}) run(*each, kFrame, 30);
  CHECK(clone.state_hash() == cloth.state_hash());
  CHECK(changed.state_hash() == cloth.state_hash());
  CHECK(gap(cloth) <= 1e-4);
}

/// A particle of 2 kg that is sewn to a pin, and hangs there.
SceneDescription hanging_by_a_seam() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, 0, 0}};
  scene.masses = {1, 2};
  scene.fixed = {0};
  scene.seams = {{0, 1, 0.5}};
  return scene;
}

TEST_CASE("what a seam that is released held falls freely, and is caught where it closes again") {
  for (const Backend backend : kBackends) {
    for (const int rate : {30, 60, 240}) {
      CAPTURE(rate);
      const double frame = 1. / rate;
      Cloth cloth = cloth_of(hanging_by_a_seam(), small_steps(backend));
      run(cloth, frame, rate / 5);
      REQUIRE(std::abs(cloth.position(1).y) <= 1e-4);
      REQUIRE(cloth.release_seams(std::array{0u}));
      for (int k = 1; k <= rate / 2; ++k) {
        const StepReport report = step(cloth, frame);
        CHECK(report.status == Status::converged);
        CHECK(report.open_seams == 0);
        CHECK(report.max_seam_gap == 0);
        CHECK(report.seam_work == 0);
      }
      const double t = (rate / 2) * frame;
      CHECK(cloth.position(1).y == doctest::Approx(-5 * t * t).epsilon(0.01));
      CHECK(cloth.velocity(1).y == doctest::Approx(-10 * t).epsilon(0.01));
      REQUIRE(cloth.close_seams(std::array{0u}));
      CHECK(step(cloth, frame).open_seams == 1);
      run(cloth, frame, rate);
      const StepReport report = step(cloth, frame);
      CHECK(report.open_seams == 0);
      CHECK(report.max_seam_gap <= 1e-4);
      CHECK(std::abs(cloth.position(1).y) <= 1e-4);
    }
  }
}

TEST_CASE("an open seam that is released pulls no more, and is neither late nor held apart") {
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(two_particles({0, 1, 0.5}), small_steps(backend));
    run(cloth, kFrame, 10);
    REQUIRE(cloth.release_seams(std::array{0u}));
    const double from = gap(cloth);
    for (int frame = 0; frame < 5; ++frame) CHECK(step(cloth, kFrame).status == Status::converged);
    CHECK(gap(cloth) == doctest::Approx(from - 5 * kFrame * 1.2).epsilon(0.01));  // at its speed
    SceneDescription apart = two_particles({0, 1, 0.1});
    apart.fixed = {0, 1};
    Cloth held = cloth_of(apart, small_steps(backend));
    for (int frame = 0; frame < 10; ++frame) run(held, kFrame, 1);
    CHECK(step(held, kFrame).status == Status::infeasible);
    REQUIRE(held.release_seams(std::array{0u}));
    CHECK(step(held, kFrame).held_apart == 0);
    CHECK(step(held, kFrame).status == Status::converged);
  }
}

TEST_CASE("released seams stay so in a clone, a change, and a state that is loaded or placed") {
  Cloth cloth = cloth_of(hanging_by_a_seam(), small_steps(Backend::simd));
  run(cloth, kFrame, 5);
  REQUIRE(cloth.release_seams(std::array{0u}));
  Cloth clone = cloth.clone(), changed = cloth.clone(), placed = cloth.clone();
  Cloth loaded = cloth_of(hanging_by_a_seam(), small_steps(Backend::simd));
  REQUIRE(loaded.load_state(cloth.save_state()));
  REQUIRE(changed.change({.damping = Damping{}}));
  std::vector<Vec3> places(2);
  REQUIRE(placed.read_positions(places));
  REQUIRE(placed.write_positions(places));
  for (Cloth* each : {&cloth, &clone, &changed, &loaded, &placed}) run(*each, kFrame, 30);
  CHECK(cloth.position(1).y < -1);
  for (Cloth* each : {&clone, &changed, &loaded}) CHECK(each->state_hash() == cloth.state_hash());
  CHECK(placed.position(1).y == doctest::Approx(cloth.position(1).y).epsilon(0.01));
}

TEST_CASE("seams that are not there are neither released nor closed") {
  Cloth cloth = cloth_of(hanging_by_a_seam(), small_steps(Backend::simd));
  run(cloth, kFrame, 5);
  CHECK(cloth.release_seams(std::array{0u, 1u}).error() ==
        "seams[1]: no such seam, the scene has 1 (1)");
  CHECK(cloth.close_seams(std::array{7u}).error() == "seams[0]: no such seam, the scene has 1 (7)");
  run(cloth, kFrame, 5);
  CHECK(std::abs(cloth.position(1).y) <= 1e-4);
}

TEST_CASE("seams that make no sense, and solvers that know none, are refused") {
  const auto refusal_of = [](const Seam& seam) {
    const auto model = build_model(two_particles(seam));
    return model ? std::string() : model.error();
  };
  CHECK(refusal_of({0, 2}).find("seams[0].b") == 0);
  CHECK(refusal_of({1, 1}).find("seams[0]") == 0);
  CHECK(refusal_of({0, 1, 0}).find("seams[0].time") == 0);
  CHECK(refusal_of({0, 1, 1, 0}).find("seams[0].max_force") == 0);
  const auto cloth = Cloth::create(model_of(two_particles({0, 1})), {.solver = Solver::yarn});
  REQUIRE_FALSE(cloth);
  CHECK(cloth.error().find("seams") == 0);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_seams
