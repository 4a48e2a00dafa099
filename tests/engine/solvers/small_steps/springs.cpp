/// Constraints with a compliance, against closed forms, on both backends.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"

namespace weft::test::engine_solvers_small_steps_springs {
namespace {

Settings small_steps(Backend backend, double tolerance = 1e-3) {
  Settings settings;
  settings.backend = backend;
  settings.solver = Solver::small_steps;
  settings.tolerance = tolerance;
  settings.threads = 1;
  return settings;
}

/// A line of n edges from the origin down, `length` m and `mass` kg in all, its first particle
/// fixed; half a share of the mass is at its ends. `compliance`: of the whole line.
SceneDescription hanging_line(int n, double length, double mass, double compliance) {
  SceneDescription scene;
  for (int i = 0; i <= n; ++i) {
    scene.positions.push_back({0, -length * i / n, 0});
    scene.masses.push_back(mass / n * (i == 0 || i == n ? 0.5 : 1));
    if (i == 0) continue;
    const auto particle = static_cast<std::uint32_t>(i);
    scene.constraints.push_back(
        {particle - 1, particle, length / n, ConstraintKind::distance, compliance / n});
  }
  scene.fixed = {0};
  return scene;
}

/// Masses of 1 kg at the ends of a spring, 1 m long at rest, `stretch` longer.
SceneDescription free_spring(double stretch, double compliance) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1 + stretch, 0, 0}};
  scene.masses = {1, 1};
  scene.gravity = {0, 0, 0};
  scene.constraints = {{0, 1, 1, ConstraintKind::distance, compliance}};
  return scene;
}

double span(const Cloth& cloth) { return cloth.position(1).x - cloth.position(0).x; }

TEST_CASE("a line that hangs is stretched by its weight, half of it on average") {
  const double mass = 0.2, compliance = 0.02;  // m g compliance / 2 = 2 cm of 1 m
  for (const Backend backend : kBackends) {
    for (const int n : {4, 16, 64}) {
      SceneDescription scene = hanging_line(n, 1, mass, compliance);
      scene.damping.stretch = 0.05;
      scene.damping.motion = 2;
      Cloth cloth = cloth_of(scene, small_steps(backend));
      run(cloth, 0.01, 400);
      const double stretch = -1 - cloth.position(static_cast<std::uint32_t>(n)).y;
      CAPTURE(n);
      CHECK(stretch == doctest::Approx(mass * 10 * compliance / 2).epsilon(0.02));
    }
  }
}

TEST_CASE("two masses on a spring swing with its frequency, and lose and gain no energy") {
  for (const Backend backend : kBackends) {
    const double stretch = 0.01, compliance = 1e-3;
    const double frequency = std::sqrt(2 / compliance);
    Settings settings = small_steps(backend, 1e-4);
    settings.substeps = 100;
    Cloth cloth = cloth_of(free_spring(stretch, compliance), settings);
    const double energy = cloth.energy().total();
    CHECK(energy == doctest::Approx(stretch * stretch / (2 * compliance)));
    const double dt = 2 * std::numbers::pi / frequency / 16;
    for (int i = 1; i <= 64; ++i) {
      step(cloth, dt);
      CAPTURE(i);
      CHECK(std::abs(span(cloth) - 1 - stretch * std::cos(frequency * dt * i)) < 0.02 * stretch);
      CHECK(cloth.energy().total() < energy * (1 + 1e-3));
      CHECK(cloth.energy().total() > energy * 0.96);
    }
  }
}

TEST_CASE("damping of stretch takes what its time constant says from each swing") {
  for (const Backend backend : kBackends) {
    const double stretch = 0.01, compliance = 1e-3, frequency = std::sqrt(2 / compliance);
    const double tau = 0.2 / frequency, ratio = 0.5 * tau * frequency;  // of critical damping
    SceneDescription scene = free_spring(stretch, compliance);
    scene.damping.stretch = tau;
    Settings settings = small_steps(backend, 1e-4);
    settings.substeps = 200;
    Cloth cloth = cloth_of(scene, settings);
    const double damped = frequency * std::sqrt(1 - ratio * ratio);
    const double period = 2 * std::numbers::pi / damped;
    for (int i = 1; i <= 3; ++i) {
      step(cloth, period);
      const double expected = stretch * std::exp(-ratio * frequency * period * i);
      CHECK(span(cloth) - 1 == doctest::Approx(expected).epsilon(0.03));
    }
  }
}

TEST_CASE("stiffness over nine decades side by side keeps its laws and gains no energy") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = hanging_line(40, 1, 0.2, 0);
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
      scene.constraints[i].compliance = std::pow(10., -10. + static_cast<double>(i % 10));
    }
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
      scene.positions[i] = {-scene.positions[i].y, 0, 0};
    }
    Cloth cloth = cloth_of(scene, small_steps(backend, 0.01));
    const double start = cloth.energy().total();
    for (int frame = 0; frame < 100; ++frame) {
      const StepReport report = step(cloth, 0.01);
      CAPTURE(frame);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_error <= 0.01);
      const Energy energy = cloth.energy();
      REQUIRE(energy.kinetic + energy.potential < start + 1e-3);
    }
  }
}

TEST_CASE("a rope that is a spring pulls and never pushes") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = free_spring(0.01, 1e-3);
    scene.constraints[0].kind = ConstraintKind::rope;
    Settings settings = small_steps(backend, 1e-4);
    settings.substeps = 100;
    Cloth cloth = cloth_of(scene, settings);
    double longest = 0, shortest = 2;
    for (int frame = 0; frame < 40; ++frame) {
      step(cloth, 0.01);
      longest = std::max(longest, span(cloth));
      shortest = std::min(shortest, span(cloth));
    }
    CHECK(longest < 1.0101);
    // A quarter of a swing, and then each end flies on with half of the speed.
    const double frequency = std::sqrt(2 / 1e-3), flight = 0.4 - std::numbers::pi / 2 / frequency;
    CHECK(shortest == doctest::Approx(1 - 0.01 * frequency * flight).epsilon(0.02));
  }
}

TEST_CASE("springs keep momentum, and a spring at a hub is one too") {
  for (const Backend backend : kBackends) {
    SceneDescription scene;
    scene.gravity = {0, 0, 0};
    scene.positions = {{0, 0, 0}};
    scene.masses = {1};
    scene.velocities = {{0.3, 0, 0}};
    for (std::uint32_t i = 1; i <= 20; ++i) {
      const double angle = 0.3 * i;
      scene.positions.push_back({1.02 * std::cos(angle), 1.02 * std::sin(angle), 0.1 * i});
      scene.masses.push_back(0.5 + 0.1 * i);
      scene.velocities.push_back({0, 0.1 * i, -0.2});
      scene.constraints.push_back({0, i, 1, ConstraintKind::distance, 1e-2});
    }
    Settings settings = small_steps(backend, 1e-3);
    settings.scheme = Scheme::implicit;  // which gains no energy that would have to be taken out
    Cloth cloth = cloth_of(scene, settings);
    const Vec3 before = momentum(scene.masses, velocities(cloth));
    for (int frame = 0; frame < 50; ++frame) REQUIRE(step(cloth, 0.01).max_error <= 1e-3);
    const Vec3 after = momentum(scene.masses, velocities(cloth));
    CHECK(after.x == doctest::Approx(before.x).epsilon(1e-3));
    CHECK(after.y == doctest::Approx(before.y).epsilon(1e-3));
    CHECK(after.z == doctest::Approx(before.z).epsilon(1e-3));
  }
}

TEST_CASE("a sheet of springs moves alike in lanes and in double, and with any number of threads") {
  for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
    SceneDescription scene = scene_of("corners", 21);
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
      scene.constraints[i].compliance = i % 3 == 0 ? 0 : 1e-4 * static_cast<double>(i % 5);
    }
    scene.damping.stretch = 0.001;
    Settings settings = small_steps(Backend::simd);
    settings.iterations = 1;  // no local passes, whose choices differ by rounding
    settings.scheme = scheme;
    settings.substeps = 12;
    Cloth lanes = cloth_of(scene, settings);
    settings.threads = 2;
    Cloth threads = cloth_of(scene, settings);
    settings.backend = Backend::reference;
    Cloth reference = cloth_of(scene, settings);
    for (Cloth* cloth : {&lanes, &threads, &reference}) run(*cloth, 0.01, 10);
    CHECK(lanes.state_hash() == threads.state_hash());
    CHECK(largest_distance(positions(lanes), positions(reference)) < 2e-5);
  }
}

TEST_CASE("a spring too stiff to be seen is a rigid edge") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = scene_of("corners", 11);
    Settings settings = small_steps(backend, 0.01);
    settings.substeps = 20;
    settings.iterations = 1;
    for (Constraint& c : scene.constraints) c.compliance = 1e-18;
    Cloth springs = cloth_of(scene, settings);
    for (Constraint& c : scene.constraints) c.compliance = 0;
    scene.constraints[0].compliance = 1e-18;  // still no yarns
    Cloth rigid = cloth_of(scene, settings);
    run(springs, 0.01, 30);
    run(rigid, 0.01, 30);
    CHECK(largest_distance(positions(springs), positions(rigid)) < 1e-6);
  }
}

TEST_CASE("springs are for small steps, where automatic chooses") {
  const auto model = model_of(free_spring(0.01, 1e-3));
  CHECK(Cloth::create(model, {}).value().settings().solver == Solver::small_steps);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_springs
