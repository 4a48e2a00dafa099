/// Scheme rattle: second order, its guard, and that every solver and backend means the same by it.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_rattle {
namespace {

Settings rattle(Settings settings) {
  settings.scheme = Scheme::rattle;
  return settings;
}

Settings by(Solver solver, double tolerance) {
  Settings settings = tight(tolerance);
  settings.solver = solver;
  return settings;
}

Settings direct(double tolerance) { return by(Solver::direct, tolerance); }

constexpr std::array kSolvers{Solver::gauss_seidel, Solver::direct, Solver::yarn};

/// Positions after 0.4 s, in steps of 0.01 s / `parts`.
std::vector<Vec3> after_swinging(int size, const Settings& settings, int parts) {
  Cloth cloth = cloth_of(scene_of("hang", size), settings);
  run(cloth, 0.01 / parts, 40 * parts);
  return positions(cloth);
}

struct Errors {
  double first = 0;  ///< m, at 0.01 s
  double order = 0;  ///< by a line through the errors at 0.01, 0.005, 0.0025, 0.00125 s
};

Errors errors(int size, const Settings& settings, const std::vector<Vec3>& converged) {
  std::vector<double> logarithms;
  for (const int parts : {1, 2, 4, 8}) {
    const std::vector<Vec3> found = after_swinging(size, settings, parts);
    logarithms.push_back(std::log2(largest_distance(found, converged)));
  }
  const auto& y = logarithms;
  return {std::exp2(y[0]), (3 * (y[0] - y[3]) + y[1] - y[2]) / 10};
}

void check_order(int size) {
  const std::vector<Vec3> converged = after_swinging(size, rattle(direct(1e-9)), 64);
  for (const Settings& settings : {direct(1e-9), by(Solver::yarn, 1e-6)}) {
    CAPTURE(name(settings.solver));
    const Errors second = errors(size, rattle(settings), converged);
    const Errors first = errors(size, settings, converged);
    CHECK(second.order >= 1.9);
    CHECK(second.order < 2.2);
    CHECK(first.order > 0.5);
    CHECK(first.order < 1.2);
    CHECK(second.first <= first.first / 20);
  }
}

TEST_CASE("rattle is second order, the paper's scheme first") { check_order(8); }

TEST_CASE("rattle is second order at full size" * doctest::test_suite("slow")) { check_order(20); }

TEST_CASE("gauss_seidel on both backends, by all methods, moves as the direct solver does") {
  const std::vector<Vec3> expected = after_swinging(8, rattle(direct(1e-9)), 1);
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    CHECK(largest_distance(after_swinging(8, rattle(with(tight(1e-6), method)), 1), expected) <
          2e-6);
  }
}

TEST_CASE("the yarn solver moves as the direct solver does, over ropes, hubs and contacts too" *
          doctest::test_suite("slow")) {
  struct Case {
    NamedScene scene;
    int steps;
    double dt, tolerance, apart;
  };
  const Case cases[] = {{{"hang", scene_of("hang", 20)}, 40, 0.01, 1e-6, 1e-6},
                        {{"corners", scene_of("corners", 11)}, 60, 0.002, 1e-6, 1e-5},
                        {{"random mesh", random_sheet(12, 5)}, 10, 0.002, 1e-6, 1e-5},
                        {{"ropes", braced_sheet(12)}, 10, 0.005, 1e-4, 1e-3},
                        {{"hub", hub_sheet(9)}, 10, 0.001, 1e-3, 1e-3},
                        {{"hang_sphere", scene_of("hang_sphere", 10)}, 30, 0.005, 1e-5, 1e-3},
                        {{"sphere_drop", scene_of("sphere_drop", 10)}, 30, 0.002, 1e-5, 1e-3}};
  for (const Case& c : cases) {
    CAPTURE(c.scene.name);
    Cloth expected = cloth_of(c.scene.scene, rattle(direct(c.tolerance)));
    Cloth found = cloth_of(c.scene.scene, rattle(by(Solver::yarn, c.tolerance)));
    int fallbacks = 0;
    for (int k = 0; k < c.steps; ++k) {
      const StepReport report = step(found, c.dt);
      step(expected, c.dt);
      REQUIRE(report.status == Status::converged);
      fallbacks += report.scheme_fallbacks;
    }
    CHECK(fallbacks <= (c.scene.name == "hub" ? 2 : 0));
    CHECK(largest_distance(positions(found), positions(expected)) < c.apart);
  }
}

/// How many of one sheet is chance. Where the guard judged rounding there were 50 of these 120.
TEST_CASE("few steps of sheets with a hub are left to scheme paper") {
  int fallbacks = 0;
  for (std::uint32_t n = 5; n <= 16; ++n) {
    Cloth cloth = cloth_of(hub_sheet(n), rattle(by(Solver::yarn, 1e-3)));
    for (int k = 0; k < 10; ++k) fallbacks += step(cloth, 0.001).scheme_fallbacks;
  }
  CHECK(fallbacks <= 36);
}

TEST_CASE("rattle keeps the energy of a swinging sheet but for a thousandth") {
  for (const Settings& settings :
       {on(Backend::reference, tight(1e-5)), tight(1e-5), by(Solver::yarn, 1e-5)}) {
    CAPTURE(name(settings.backend));
    CAPTURE(name(settings.solver));
    Cloth cloth = cloth_of(scene_of("hang", 10), rattle(settings));
    run(cloth, 0.01, 40);
    CHECK(std::abs(cloth.energy().total()) < 1e-3 * cloth.energy().kinetic);
  }
}

// A bent line of three bars, thrown spinning through space.
TEST_CASE("rattle keeps momentum, and angular momentum") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  scene.velocities = {{1, 2, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 3}};
  scene.masses = {1, 2, 3, 4};
  scene.constraints = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}};
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, rattle(direct(1e-12)));
  step(cloth, 0.01);  // the velocities given are not those of rigid bars
  const Vec3 p = momentum(scene.masses, velocities(cloth));
  const Vec3 l = angular_momentum(scene.masses, positions(cloth), velocities(cloth));
  const double energy = cloth.energy().total();
  for (int k = 0; k < 100; ++k) CHECK(step(cloth, 0.01).scheme_fallbacks == 0);
  CHECK(distance(momentum(scene.masses, velocities(cloth)), p) < 1e-11);
  CHECK(distance(angular_momentum(scene.masses, positions(cloth), velocities(cloth)), l) < 1e-9);
  CHECK(cloth.energy().total() == doctest::Approx(energy).epsilon(1e-3));
}

/// The most that any of the frames holds above the start, J.
double energy_gain(const SceneDescription& scene, const Settings& settings, int frames, double dt,
                   int& fallbacks) {
  Cloth cloth = cloth_of(scene, settings);
  const double start = cloth.energy().total();
  double gain = 0;
  for (int k = 0; k < frames; ++k) {
    const StepReport report = step(cloth, dt);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.max_strain <= settings.tolerance * (1 + 1e-12));
    fallbacks += report.scheme_fallbacks;
    gain = std::max(gain, cloth.energy().total() - start);
  }
  return gain;
}

TEST_CASE("where rattle would blow up the paper's scheme takes over, and is counted") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    Settings settings = rattle(by(solver, solver == Solver::gauss_seidel ? 1e-3 : 1e-5));
    settings.velocity_tolerance = 1e-4;
    int fallbacks = 0;
    CHECK(energy_gain(scene_of("corners", 11), settings, 100, 0.02, fallbacks) < 1e-3);
    CHECK(fallbacks > 10);
    CHECK(fallbacks <= 100);
  }
  for (const Solver solver : {Solver::direct, Solver::yarn}) {
    int fallbacks = 0;
    energy_gain(scene_of("hang", 8), rattle(by(solver, 1e-5)), 80, 0.005, fallbacks);
    CHECK(fallbacks == 0);
  }
}

// Impulses that were left out because the velocities are within tolerance would look like energy.
TEST_CASE("steps so small that no velocity leaves its tolerance keep to rattle") {
  for (const Solver solver : {Solver::direct, Solver::yarn}) {
    for (const double tolerance : {0.01, 1e-5}) {
      CAPTURE(name(solver));
      CAPTURE(tolerance);
      Settings settings = rattle({});
      settings.solver = solver;
      settings.tolerance = tolerance;
      int fallbacks = 0;
      CHECK(energy_gain(scene_of("hang", 20), settings, 200, 0.0005, fallbacks) < 1e-6);
      CHECK(fallbacks < 10);  // at the very start, where impulses are no larger than floats' noise
    }
  }
}

TEST_CASE("rattle gains no energy, in automatic substeps to any tolerance") {
  for (const char* scene : {"hang", "corners"}) {
    for (const double tolerance : {0.01, 0.001, 1e-5}) {
      CAPTURE(std::string(scene));
      CAPTURE(tolerance);
      Settings settings = rattle({});
      settings.tolerance = tolerance;
      int fallbacks = 0;
      CHECK(energy_gain(scene_of(scene, 21), settings, 100, 0.01, fallbacks) < 1e-3);
    }
  }
}

TEST_CASE("a substep that fell back is one of the paper's scheme with velocity correction") {
  const SceneDescription scene = scene_of("corners", 11);
  for (const Solver solver : {Solver::direct, Solver::yarn}) {
    CAPTURE(name(solver));
    Settings corrected = by(solver, 1e-6);
    corrected.velocity_correction = true;
    Cloth guarded = cloth_of(scene, rattle(by(solver, 1e-6)));
    int fallbacks = 0;
    for (int k = 0; k < 100; ++k) {
      Cloth paper = cloth_of(scene, corrected);
      REQUIRE(paper.write_positions(positions(guarded)));
      REQUIRE(paper.write_velocities(velocities(guarded)));
      const StepReport report = step(guarded, 0.02);
      if (report.scheme_fallbacks == 0) continue;
      ++fallbacks;
      step(paper, 0.02);
      if (report.halvings > 0) continue;
      // Substeps after one that was halved are solved with more care.
      const double apart = solver == Solver::yarn ? 1e-6 : 1e-12;
      REQUIRE(largest_distance(positions(paper), positions(guarded)) < apart);
      REQUIRE(largest_distance(velocities(paper), velocities(guarded)) < 100 * apart);
    }
    CHECK(fallbacks > 10);
  }
}

TEST_CASE("one substep that was chosen is one that was asked for, where it falls back too") {
  const auto model = model_of(hub_sheet(6));
  Settings settings = rattle(by(Solver::yarn, 1e-3));
  settings.substeps = kAutomaticSubsteps;
  auto chosen = Cloth::create(model, settings);
  settings.substeps = 1;
  auto asked = Cloth::create(model, settings);
  REQUIRE((chosen && asked));
  int fallbacks = 0;
  for (int k = 0; k < 20; ++k) {
    REQUIRE(asked.value().copy_state(chosen.value()));
    const StepReport report = step(chosen.value(), 0.001);
    step(asked.value(), 0.001);
    if (report.substeps > 1) continue;
    fallbacks += report.scheme_fallbacks;
    CHECK(chosen.value().state_hash() == asked.value().state_hash());
  }
  CHECK(fallbacks > 0);
}

TEST_CASE("rattle in substeps is rattle in small steps") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    Settings settings = rattle({});
    settings.solver = solver;
    settings.substeps = 1;
    Cloth small = cloth_of(scene_of("hang", 7), settings);
    settings.substeps = 3;
    Cloth whole = cloth_of(scene_of("hang", 7), settings);
    for (int frame = 0; frame < 40; ++frame) {
      int fallbacks = 0;
      for (int k = 0; k < 3; ++k) fallbacks += step(small, 0.01 / 3).scheme_fallbacks;
      CHECK(step(whole, 0.01).scheme_fallbacks == fallbacks);
      REQUIRE(whole.state_hash() == small.state_hash());
    }
  }
}

TEST_CASE("a fixed number of iterations is exactly that, whatever becomes of it") {
  Settings settings = rattle(on(each_backend()));
  settings.iterations = 5;
  Cloth cloth = cloth_of(scene_of("corners", 11), settings);
  for (int k = 0; k < 40; ++k) {
    const StepReport report = step(cloth, 0.02);
    REQUIRE(report.status == Status::fixed_iterations);
    REQUIRE(report.iterations == 5);
    REQUIRE(report.scheme_fallbacks == 0);
  }
}

/// Of a woven sheet that its pins carry along.
int fallbacks_at(Vec3 speed) {
  SceneDescription scene = scene_of(grid(12, 12));
  scene.fixed.resize(12);
  std::iota(scene.fixed.begin(), scene.fixed.end(), 0u);
  scene.velocities.assign(scene.positions.size(), speed);
  for (const std::uint32_t pin : scene.fixed) scene.velocities[pin] = {};
  Cloth cloth = cloth_of(scene, rattle({}));
  int fallbacks = 0;
  for (int k = 1; k <= 60; ++k) {
    for (const std::uint32_t pin : scene.fixed) {
      REQUIRE(cloth.move_fixed(pin, scene.positions[pin] + (k / 60.) * speed));
    }
    fallbacks += step(cloth, 1. / 60).scheme_fallbacks;
  }
  return fallbacks;
}

TEST_CASE("the work of moved pins is no reason to leave rattle") {
  const int at_rest = fallbacks_at({0, 0, 0});
  CHECK(fallbacks_at({3, 0, 0}) <= at_rest + 10);  // 42 more
  CHECK(fallbacks_at({0, 3, 0}) <= at_rest + 30);  // 106 more
  CHECK(fallbacks_at({0, 0, 3}) <= at_rest + 10);
}

TEST_CASE("rattle has the velocity correction") {
  CHECK(cloth_of(scene_of("hang", 4), rattle({})).settings().velocity_correction);
  CHECK_FALSE(cloth_of(scene_of("hang", 4), {}).settings().velocity_correction);
}

TEST_CASE("rattle with contacts: no particle deeper than the tolerance") {
  for (const Solver solver : kSolvers) {
    for (const char* name : {"hang_sphere", "sphere_drop"}) {
      CAPTURE(weft::name(solver));
      CAPTURE(std::string(name));
      Settings settings;
      settings.solver = solver;
      Cloth cloth = cloth_of(scene_of(name, 10), rattle(settings));
      for (int k = 0; k < 60; ++k) {
        const StepReport report = step(cloth, 0.01);
        REQUIRE(report.status == Status::converged);
        REQUIRE(report.max_strain <= 0.01 * (1 + 1e-12));
        REQUIRE(report.max_penetration <= settings.contact_tolerance * (1 + 1e-9));
      }
    }
  }
}

TEST_CASE("a taut rope swings as a bar does") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  scene.gravity = {0, -10, 0};
  scene.velocities = {{0, 0, 0}, {0, -4, 0}};
  for (const Settings& settings :
       {on(Backend::reference, tight(1e-6)), tight(1e-6), by(Solver::yarn, 1e-6)}) {
    Cloth bar = cloth_of(scene, rattle(settings));
    scene.constraints[0].kind = ConstraintKind::rope;
    Cloth rope = cloth_of(scene, rattle(settings));
    scene.constraints[0].kind = ConstraintKind::distance;
    run(bar, 0.005, 100);
    run(rope, 0.005, 100);
    CHECK(distance(bar.position(1), rope.position(1)) < 1e-5);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_rattle
