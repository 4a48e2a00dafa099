/// Undamped scenes must not gain energy.
///
/// The scheme removes a whole error e in one step and thereby adds speeds of up to e / h. A level
/// sheet that is let go falls freely until some edge is out of tolerance, and is caught then: by an
/// error of at most the tolerance and of what one more step adds, d^2 / (2 L) with d = g h^2 / 2
/// from rest. Only there may energy appear, and no more than all of the mass has at that speed.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"

namespace weft::test::engine_step_conservation {
namespace {

constexpr double kStep = 0.01;

/// The total energy after every one of 200 steps, less that of the start, J.
std::vector<double> energy_gains(const SceneDescription& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene, settings);
  const double start = cloth.energy().total();
  std::vector<double> gains;
  for (int k = 0; k < 200; ++k) {
    step(cloth, kStep);
    gains.push_back(cloth.energy().total() - start);
  }
  return gains;
}

double energy_of_the_catch(int size, double tolerance) {
  const double spacing = 1.0 / (size - 1);
  const double fall = 10 * kStep * kStep / 2;
  const double error = tolerance * spacing + fall * fall / (2 * spacing);
  return (error / kStep) * (error / kStep) / 2;
}

void check_hang(int size, const Settings& settings) {
  const std::vector<double> gains = energy_gains(scene_of("hang", size), settings);
  const double most = *std::max_element(gains.begin(), gains.end());
  CHECK(most < energy_of_the_catch(size, settings.tolerance));
  CHECK(*std::max_element(gains.begin() + 30, gains.end()) < 0);
  if (settings.tolerance == 0.01) CHECK(most < 1e-12);
}

TEST_CASE("hang never holds more energy than it started with") {
  for (const Method& method : kAllMethods) {
    for (const bool velocity_correction : {false, true}) {
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        CAPTURE(text(method));
        CAPTURE(velocity_correction);
        CAPTURE(tolerance);
        Settings settings = with(paper_settings(), method);
        settings.tolerance = tolerance;
        settings.velocity_correction = velocity_correction;
        check_hang(8, settings);
      }
    }
  }
}

TEST_CASE("hang at full size never holds more energy than it started with" *
          doctest::test_suite("slow")) {
  const Backend backend = each_backend();
  for (const double tolerance : {0.1, 0.01, 1e-5}) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(tolerance);
      CAPTURE(velocity_correction);
      Settings settings = on(backend);
      settings.tolerance = tolerance;
      settings.velocity_correction = velocity_correction;
      check_hang(20, settings);
    }
  }
}

/// What a frame leaves within tolerance, divided by 10 us, would be metres per second.
TEST_CASE("a step far shorter than the last one makes no speed of what that one left") {
  constexpr double kFrame = 1. / 60, kRest = 1e-5;
  for (const Solver solver : {Solver::automatic, Solver::direct}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      CAPTURE(name(solver));
      CAPTURE(name(scheme));
      Cloth cloth = cloth_of(scene_of("hang", 20), {.solver = solver, .scheme = scheme});
      const double start = cloth.energy().total();
      for (int k = 0; k < 100; ++k) {
        REQUIRE(step(cloth, kFrame).status == Status::converged);
        CHECK(cloth.energy().total() < start + 1e-5);
        REQUIRE(step(cloth, kRest).status == Status::converged);
        CHECK(cloth.energy().total() < start + 1e-5);
      }
    }
  }
}

/// A chain that is let go level, with a rope, hardly longer than taut, from its pin to every
/// particle beyond the next.
SceneDescription tethered_chain(std::uint32_t particles) {
  SceneDescription scene;
  const double edge = 1.0 / (particles - 1);
  for (std::uint32_t i = 0; i < particles; ++i) {
    scene.positions.push_back({i * edge, 0, 0});
    scene.masses.push_back(1.0 / particles);
    if (i > 0) scene.constraints.push_back({i - 1, i, edge});
    if (i > 1) scene.constraints.push_back({0, i, 1.01 * i * edge, ConstraintKind::rope});
  }
  scene.fixed = {0};
  return scene;
}

/// The most that any of 60 steps gains, J.
double most_gained(const SceneDescription& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene, settings);
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    const double before = cloth.energy().total();
    step(cloth, kStep);
    most = std::max(most, cloth.energy().total() - before);
  }
  return most;
}

/// By how much any of 60 steps ends above the start, J.
double most_above_start(const SceneDescription& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene, settings);
  const double start = cloth.energy().total();
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    step(cloth, kStep);
    most = std::max(most, cloth.energy().total() - start);
  }
  return most;
}

// Small steps may give back in one step what their springs took in those before.
TEST_CASE("ropes from the pin to all of a chain bring no energy") {
  CHECK(most_gained(tethered_chain(20), {.scheme = Scheme::paper}) < 1e-3);  // 678 J
  CHECK(most_above_start(tethered_chain(20), {}) < 1e-3);
}

struct Branch {
  SceneDescription scene;
  Settings settings;
  double dt;
};

SceneDescription scene_with(std::vector<Vec3> positions, std::vector<Vec3> velocities,
                            std::vector<double> masses, std::vector<Constraint> constraints) {
  SceneDescription scene;
  scene.positions = std::move(positions);
  scene.velocities = std::move(velocities);
  scene.masses = std::move(masses);
  scene.constraints = std::move(constraints);
  scene.gravity = {0, 0, 0};
  return scene;
}

constexpr ConstraintKind kRope = ConstraintKind::rope;

/// A star of ropes, thrown.
Branch star() {
  Branch branch{scene_with({{-0.045745, -0.13051, 0.030098},
                            {-0.099211, -0.02577, 0.068505},
                            {-0.036598, -0.22518, 0.10855},
                            {-0.004404, -0.22555, -0.049778},
                            {-0.098769, -0.016213, 0.071985},
                            {0.043138, -0.21101, 0.12572},
                            {0.085844, -0.2129, -0.060359}},
                           {{-0.72877, -0.6448, 0.43928},
                            {0, 0, 0},
                            {-0.62244, -0.74694, 0.30528},
                            {-1.929, -1.6156, 0.79789},
                            {0, 0, 0},
                            {-1.2729, -1.0478, 0.63493},
                            {-1.153, -1.1573, 0.25932}},
                           {0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01},
                           {{0, 1, 0.1237, kRope},
                            {0, 2, 0.12329, kRope},
                            {0, 3, 0.13086, kRope},
                            {0, 4, 0.1362, kRope},
                            {0, 5, 0.15337, kRope},
                            {0, 6, 0.17969, kRope}}),
                {},
                1. / 30};
  branch.scene.fixed = {1, 4};
  branch.settings.tolerance = 1e-3;
  branch.settings.solver = Solver::yarn;
  return branch;
}

/// A ring of four, held at a sphere, over another one.
Branch ring() {
  Branch branch{scene_with({{0.16767, -0.37307, -0.053028},
                            {0.2912, -0.57626, -0.16278},
                            {0.16895, -0.37347, -0.051142},
                            {-9.9671e-10, -0.1851, 0.018647},
                            {-0.010237, -0.68041, 0.0032579}},
                           {{-0.11605, -0.23656, -0.35564},
                            {0.56694, -0.58703, 0.68227},
                            {-0.10474, -0.23758, -0.3301},
                            {0, 0, 0},
                            {0, 0, 0}},
                           {0.0036022, 0.0020732, 0.12508, 0.0022124, 0.054272},
                           {{0, 1, 0.26191}, {1, 2, 0.26179}, {2, 3, 0.26248}, {3, 0, 0.26188}}),
                {},
                0.05};
  branch.scene.gravity = {0, -10, 0};
  branch.scene.fixed = branch.scene.spheres = {3, 4};
  branch.scene.radii = {0.005812, 0.005812, 0.005812, 0.08761, 0.35374};
  branch.settings.tolerance = 1e-5;
  branch.settings.solver = Solver::yarn;
  return branch;
}

/// A chain with a triangle in it, and a sphere that runs into it.
Branch folded() {
  Branch branch{scene_with({{0.012222, 0.031832, -0.01449},
                            {-0.049815, 0.051673, -0.084022},
                            {-0.031067, 0.07453, -0.087837},
                            {-0.0070031, 0.092004, -0.085811},
                            {-0.0011882, 0.067528, -0.1018},
                            {-0.112, 0, -0.15415},
                            {-0.092325, -0.030478, -0.10685},
                            {0.045977, 0.12087, -0.11936},
                            {-0.091672, -0.16888, 0.087262}},
                           {{0.1755, 0.53892, -0.19415},
                            {0.11069, 0.16644, -0.26027},
                            {-0.09774, 0.40358, -0.12281},
                            {-0.18944, 0.54153, -0.10997},
                            {-0.271, 0.54157, -0.14376},
                            {0, 0, 0},
                            {-0.4374, 0.20107, 0.37735},
                            {0.18466, 0.52749, 0.59003},
                            {0.20956, 0.51127, 0.45102}},
                           {0.029323, 0.012978, 0.0048198, 0.01892, 0.0061384, 0.015087, 0.0095428,
                            0.027748, 0.64821},
                           {{0, 1, 0.095273},
                            {1, 2, 0.029808},
                            {0, 2, 0.095273},
                            {2, 3, 0.029808},
                            {3, 4, 0.029808},
                            {5, 6, 0.059616},
                            {1, 6, 0.095273},
                            {2, 7, 0.095273}}),
                {},
                1. / 60};
  branch.scene.fixed = {5};
  branch.scene.spheres = {8};
  branch.scene.radii = {0.001905, 0.001905, 0.001905, 0.001905, 0.001905,
                        0.001905, 0.001905, 0.001905, 0.23554};
  branch.settings.tolerance = 1e-5;
  branch.settings.substeps = 1;
  branch.settings.solver = Solver::direct;
  return branch;
}

/// What a step gains, of the kinetic energy before it.
double share_gained(const Branch& branch) {
  Cloth cloth = cloth_of(branch.scene, branch.settings);
  const Energy before = cloth.energy();
  CHECK(step(cloth, branch.dt).status == Status::converged);
  return (cloth.energy().total() - before.total()) / before.kinetic;
}

// Found at random: all constraints are kept there as well as where the motion leads.
TEST_CASE("a far place that keeps all constraints is not gone to") {
  CHECK(share_gained(star()) < 0.1);
  CHECK(share_gained(ring()) < 0.1);
  CHECK(share_gained(folded()) < 0.1);
}

TEST_CASE("energy() is kinetic plus potential of what is not fixed") {
  const Backend backend = each_backend();
  for (const int size : {5, 21}) {  // 21: slots without a particle stand between the others
    CAPTURE(size);
    SceneDescription scene = scene_of("corners", size);
    scene.gravity = {1, -10, 2};
    scene.velocities.assign(scene.positions.size(), {1, 2, 3});
    Cloth cloth = cloth_of(scene, on(backend));
    const double moving = scene.masses[0] * static_cast<double>(scene.positions.size() - 2);
    CHECK(cloth.energy().kinetic == doctest::Approx(moving * 14 / 2).epsilon(1e-13));
    CHECK(cloth.energy().total() ==
          doctest::Approx(energy(scene, scene.positions, scene.velocities)).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace weft::test::engine_step_conservation
