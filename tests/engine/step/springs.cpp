/// Constraints with a compliance in steps by a prediction and a solver, against closed forms, dense
/// matrices and each other. (Small steps: engine/solvers/small_steps/springs.)
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/dense_projection.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_springs {
namespace {

struct Way {
  const char* name;
  Solver solver;
  Backend backend;
};
constexpr Way kWays[] = {{"gauss_seidel, reference", Solver::gauss_seidel, Backend::reference},
                         {"direct", Solver::direct, Backend::simd},
                         {"gauss_seidel, simd", Solver::gauss_seidel, Backend::simd},
                         {"yarn", Solver::yarn, Backend::simd}};

Settings settings_of(const Way& way, double tolerance) {
  Settings settings;
  settings.solver = way.solver;
  settings.backend = way.backend;
  settings.tolerance = tolerance;
  settings.threads = 1;
  return settings;
}

/// f(settings) with every solver that takes springs.
template <class F>
void for_each_way(double tolerance, F f) {
  for (const Way& way : kWays) {
    CAPTURE(std::string(way.name));
    f(settings_of(way, tolerance));
  }
}

/// A line of n edges from the origin along `direction`, 1 m and `mass` kg in all, its first
/// particle fixed; half a share of the mass is at its ends. `compliance`: of the whole line.
SceneDescription line(int n, Vec3 direction, double mass, double compliance) {
  SceneDescription scene;
  for (int i = 0; i <= n; ++i) {
    scene.positions.push_back((1. * i / n) * direction);
    scene.masses.push_back(mass / n * (i == 0 || i == n ? 0.5 : 1));
    if (i == 0) continue;
    const auto particle = static_cast<std::uint32_t>(i);
    scene.constraints.push_back(
        {particle - 1, particle, 1. / n, ConstraintKind::distance, compliance / n});
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

/// A sheet in which rigid edges, ropes and springs of several stiffnesses stand side by side.
SceneDescription mixed_sheet(int size) {
  SceneDescription scene = scene_of("corners", size);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    scene.constraints[i].compliance = i % 3 == 0 ? 0 : 1e-4 * static_cast<double>(i % 5);
    if (i % 7 == 0) scene.constraints[i].kind = ConstraintKind::rope;
  }
  return scene;
}

TEST_CASE("a line of springs that hangs is stretched by its weight, half of it on average") {
  const double mass = 0.2, compliance = 0.02;  // m g compliance / 2 = 2 cm of 1 m
  for_each_way(1e-4, [&](const Settings& settings) {
    for (const int n : {4, 16, 64}) {
      SceneDescription scene = line(n, {0, -1, 0}, mass, compliance);
      scene.damping.stretch = 0.05;
      scene.damping.motion = 2;
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 400);
      const double stretch = -1 - cloth.position(static_cast<std::uint32_t>(n)).y;
      CAPTURE(n);
      CHECK(stretch == doctest::Approx(mass * 10 * compliance / 2).epsilon(0.01));
    }
  });
}

/// By the implicit Euler method a swing of the angular frequency w loses the part w h / 2 of its
/// amplitude in the time 1 / w.
TEST_CASE("two masses on a spring swing with its frequency, and their energy never rises") {
  const double stretch = 0.01, compliance = 1e-3, frequency = std::sqrt(2 / compliance);
  for_each_way(1e-6, [&](Settings settings) {
    settings.substeps = 100;
    Cloth cloth = cloth_of(free_spring(stretch, compliance), settings);
    double energy = cloth.energy().total();
    CHECK(energy == doctest::Approx(stretch * stretch / (2 * compliance)));
    const double dt = 2 * std::numbers::pi / frequency / 16, h = dt / settings.substeps;
    for (int i = 1; i <= 64; ++i) {
      const StepReport report = step(cloth, dt);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_error <= 1e-6 * (1 + 1e-6));
      const double left = std::exp(-frequency * frequency * h / 2 * dt * i);
      CAPTURE(i);
      CHECK(std::abs(span(cloth) - 1 - left * stretch * std::cos(frequency * dt * i)) <
            0.01 * stretch);
      CHECK(cloth.energy().total() < energy * (1 + 1e-3));
      energy = cloth.energy().total();
    }
  });
}

TEST_CASE("damping of stretch takes what its time constant says from each swing of a spring") {
  const double stretch = 0.01, compliance = 1e-3, frequency = std::sqrt(2 / compliance);
  const double tau = 0.2 / frequency, ratio = 0.5 * tau * frequency;  // of critical damping
  for_each_way(1e-6, [&](Settings settings) {
    SceneDescription scene = free_spring(stretch, compliance);
    scene.damping.stretch = tau;
    settings.substeps = 1000;
    Cloth cloth = cloth_of(scene, settings);
    const double damped = frequency * std::sqrt(1 - ratio * ratio);
    const double period = 2 * std::numbers::pi / damped;
    for (int i = 1; i <= 3; ++i) {
      step(cloth, period);
      const double expected = stretch * std::exp(-ratio * frequency * period * i);
      CHECK(span(cloth) - 1 == doctest::Approx(expected).epsilon(0.07));
    }
  });
}

TEST_CASE("springs over nine decades side by side keep their laws and gain no energy") {
  for_each_way(0.001, [](const Settings& settings) {
    SceneDescription scene = line(40, {1, 0, 0}, 0.2, 0);
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
      scene.constraints[i].compliance = std::pow(10., -10. + static_cast<double>(i % 10));
    }
    Cloth cloth = cloth_of(scene, settings);
    const double start = cloth.energy().total();
    for (int frame = 0; frame < 100; ++frame) {
      const StepReport report = step(cloth, 0.01);
      CAPTURE(frame);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_error <= 0.001 * (1 + 1e-6));
      REQUIRE(cloth.energy().total() < start + 1e-3);
    }
  });
}

TEST_CASE("a rope that is a spring pulls and never pushes") {
  for_each_way(1e-6, [](Settings settings) {
    SceneDescription scene = free_spring(0.01, 1e-3);
    scene.constraints[0].kind = ConstraintKind::rope;
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
  });
}

/// A particle in the middle of n others. More than 16 constraints make it a hub, more than 64 a
/// body of the direct solver.
SceneDescription wheel(std::uint32_t n) {
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  scene.velocities = {{0.3, 0, 0}};
  for (std::uint32_t i = 1; i <= n; ++i) {
    const double angle = 0.3 * i;
    scene.positions.push_back({1.02 * std::cos(angle), 1.02 * std::sin(angle), 0.2 * i / n});
    scene.masses.push_back(0.5 + 2. * i / n);
    scene.velocities.push_back({0, 2. * i / n, -0.2});
    scene.constraints.push_back({0, i, 1, ConstraintKind::distance, i % 4 == 0 ? 0 : 1e-2});
    if (i % 5 == 0) scene.constraints.back().kind = ConstraintKind::rope;
  }
  return scene;
}

TEST_CASE("springs keep momentum, and a spring at a hub or a body is one too") {
  for_each_way(1e-5, [](const Settings& settings) {
    for (const std::uint32_t n : {20u, 70u}) {
      CAPTURE(n);
      const SceneDescription scene = wheel(n);
      Cloth cloth = cloth_of(scene, settings);
      const Vec3 before = momentum(scene.masses, velocities(cloth));
      for (int frame = 0; frame < 50; ++frame) {
        const StepReport report = step(cloth, 0.01);
        REQUIRE(report.status == Status::converged);
        REQUIRE(report.max_error <= 1e-5 * (1 + 1e-6));
      }
      const Vec3 after = momentum(scene.masses, velocities(cloth));
      CHECK(length(after - before) < 1e-4 * length(before));
    }
  });
}

TEST_CASE("a load of ten thousand times its springs' mass hangs by what they give way") {
  const double load = 1, compliance = 0.01;  // m g compliance = 10 cm of 1 m
  for (const int rigid : {0, 3}) {           // so many of the edges
    SceneDescription scene = line(10, {0, -1, 0}, 1e-3, compliance);
    for (int i = 0; i < rigid; ++i)
      scene.constraints[static_cast<std::size_t>(3 * i)].compliance = 0;
    scene.masses.back() = load;
    scene.damping.motion = 4;
    scene.damping.stretch = 0.05;
    Cloth cloth = cloth_of(scene, settings_of({"direct", Solver::direct, Backend::simd}, 1e-4));
    for (int frame = 0; frame < 400; ++frame)
      REQUIRE(step(cloth, 0.01).status == Status::converged);
    const double stretch = load * 10 * compliance * (10 - rigid) / 10;
    CHECK(-1 - cloth.position(10).y == doctest::Approx(stretch).epsilon(0.01));
  }
}

TEST_CASE("a spring too stiff to be seen is a rigid edge in exact steps") {
  for_each_way(1e-6, [](Settings settings) {
    settings.substeps = 2;
    SceneDescription scene = scene_of("corners", 9);
    Cloth rigid = cloth_of(scene, settings);
    for (Constraint& c : scene.constraints) c.compliance = 1e-18;
    Cloth springs = cloth_of(scene, settings);
    run(springs, 0.01, 20);
    run(rigid, 0.01, 20);
    CHECK(largest_distance(positions(springs), positions(rigid)) < 1e-6);
  });
}

TEST_CASE("a substep of springs is what Newton's method finds by dense matrices") {
  const double h = 0.01;
  for_each_way(1e-9, [&](Settings settings) {
    if (settings.backend == Backend::simd) settings.tolerance = 1e-7;
    settings.measuring.directions = Directions::frozen;
    settings.measuring.renew_after = 0;
    settings.substeps = 1;
    for (const double compliance : {0., 1e-6, 1e-3, 1.}) {
      SceneDescription scene = scene_of("hang", 4);
      scene.gravity = {1, -10, 2};
      for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
        scene.constraints[i].compliance = i % 4 == 0 ? 1e-4 : compliance;
      }
      Cloth cloth = cloth_of(scene, settings);
      const std::vector<bool> fixed = are_fixed(scene);
      DenseProjection dense(scene, h);
      for (int i = 0; i < 3; ++i) {
        std::vector<Vec3> expected = positions(cloth);
        for (std::size_t p = 0; p < expected.size(); ++p) {
          if (fixed[p]) continue;
          const Vec3 v = cloth.velocity(static_cast<std::uint32_t>(p));
          expected[p] = expected[p] + h * v + (h * h / 2) * scene.gravity;
        }
        REQUIRE(dense.project_positions(expected));
        REQUIRE(step(cloth, h).status == Status::converged);
        CAPTURE(compliance);
        CAPTURE(i);
        CHECK(largest_distance(positions(cloth), expected) < 1e4 * settings.tolerance * 0.05);
      }
    }
  });
}

TEST_CASE("rigid edges, ropes and springs side by side move alike by all solvers") {
  const SceneDescription scene = mixed_sheet(9);
  std::vector<Vec3> expected;
  for_each_way(1e-6, [&](Settings settings) {
    settings.substeps = 4;
    Cloth cloth = cloth_of(scene, settings);
    for (int frame = 0; frame < 10; ++frame) {
      const StepReport report = step(cloth, 0.01);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_error <= 1e-6 * (1 + 1e-6));
      REQUIRE(report.max_strain > 1e-4);
    }
    if (expected.empty()) expected = positions(cloth);
    CHECK(largest_distance(positions(cloth), expected) < 1e-4);
  });
}

TEST_CASE("skipping changes no bit of springs, and anticipating nothing beyond rounding") {
  for (const char* name : {"hang", "hang_sphere"}) {
    SceneDescription scene = scene_of(name, 9);
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
      scene.constraints[i].compliance = 1e-4 * static_cast<double>(i % 3);
      if (i % 7 == 0) scene.constraints[i].kind = ConstraintKind::rope;
    }
    scene.damping.stretch = 0.002;
    for (std::size_t m = 0; m < kMethods.size(); m += 4) {
      std::vector<std::vector<Vec3>> ends;
      for (std::size_t k = m; k < m + 4; ++k) {
        CAPTURE(text(kMethods[k]));
        Settings settings = with(paper_settings(), kMethods[k]);
        settings.tolerance = 1e-4;
        Cloth cloth = cloth_of(scene, settings);
        for (int i = 0; i < 50; ++i) REQUIRE(step(cloth, 0.01).status == Status::converged);
        ends.push_back(positions(cloth));
      }
      CHECK(largest_distance(ends[0], ends[1]) == 0);
      CHECK(largest_distance(ends[2], ends[3]) == 0);
      CHECK(largest_distance(ends[0], ends[2]) < 1e-9);
    }
  }
}

TEST_CASE("a start out of tolerance is projected, and its springs are left as they are") {
  for_each_way(1e-4, [](const Settings& settings) {
    SceneDescription scene = line(2, {1, 0, 0}, 1, 1);
    scene.gravity = {0, 0, 0};
    scene.constraints[0].compliance = 0;
    scene.positions[1].x = 0.6;  // by a fifth too far from the pin
    scene.positions[2].x = 1.2;
    scene.constraints[1].compliance = 1e6;
    Cloth cloth = cloth_of(scene, settings);
    const StepReport report = step(cloth, 0.001);
    CHECK(report.status == Status::converged);
    CHECK(cloth.position(1).x == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(cloth.position(2).x == doctest::Approx(1.2).epsilon(1e-6));
    CHECK(length(cloth.velocity(1)) < 1e-2);
    CHECK(report.max_strain == doctest::Approx(0.4).epsilon(1e-3));
    CHECK(report.max_error <= 1e-4);
  });
}

TEST_CASE("what does not go with springs is refused") {
  const auto model = model_of(free_spring(0.01, 1e-3));
  const auto message = [&](const Settings& settings) {
    const auto cloth = Cloth::create(model, settings);
    return cloth ? std::string() : cloth.error();
  };
  for_each_way(0.01, [&](Settings settings) {
    CHECK(message(settings).empty());
    settings.velocity_correction = true;
    CHECK(message(settings).find("velocity_correction") != std::string::npos);
    settings.velocity_correction = false;
    settings.scheme = Scheme::rattle;
    CHECK(message(settings).find("scheme") != std::string::npos);
  });
  CHECK(message({.scheme = Scheme::rattle}).find("scheme") != std::string::npos);
  const Settings settings = Cloth::create(model, {.scheme = Scheme::paper}).value().settings();
  CHECK(settings.solver == Solver::yarn);
}

}  // namespace
}  // namespace weft::test::engine_step_springs
