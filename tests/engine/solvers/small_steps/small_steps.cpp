/// Small steps: the solver behind meshes and woven sheets alike.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_small_steps {
namespace {

Settings small_steps(double tolerance = 0.01) {
  Settings settings;
  settings.solver = Solver::small_steps;
  settings.tolerance = tolerance;
  settings.threads = 1;
  return settings;
}

SceneDescription make(std::string_view name, const scenes::Options& options) {
  auto scene = scenes::make(name, options);
  REQUIRE(scene);
  return scene.value();
}

/// Woven, braced, meshes, ropes: every kind of block. Rigid triangles lock: below 1 % there may be
/// nowhere to go.
std::vector<SceneDescription> all_kinds(double tolerance = 0.01) {
  std::vector<SceneDescription> scenes;
  if (tolerance >= 0.01) scenes.push_back(make("cape", {.size = 18}));
  const SceneDescription others[] = {make("hang", {.size = 20}),
                                     make("corners", {.size = 21}),
                                     make("four_pins", {.size = 21}),
                                     make("four_pins", {.size = 17, .diagonals = true}),
                                     make("hang", {.size = 16, .diagonals = true}),
                                     make("cape", {.size = 18, .ropes = true}),
                                     make("hang_sphere", {.size = 16})};
  scenes.insert(scenes.end(), std::begin(others), std::end(others));
  return scenes;
}

TEST_CASE("every frame is within its tolerance, and gains no energy, on every kind of cloth") {
  for (const double tolerance : {0.05, 0.01, 0.002}) {
    for (const SceneDescription& scene : all_kinds(tolerance)) {
      CAPTURE(tolerance);
      CAPTURE(scene.constraints.size());
      Cloth cloth = cloth_of(scene, small_steps(tolerance));
      const double start = cloth.energy().total();
      for (int frame = 0; frame < 120; ++frame) {
        const StepReport report = step(cloth, 0.01);
        REQUIRE(report.status == Status::converged);
        REQUIRE(report.max_strain <= tolerance);
        REQUIRE(max_strain(scene, positions(cloth)) <= tolerance * (1 + 1e-9));
        REQUIRE(report.max_penetration <= 1e-4);
        REQUIRE(cloth.energy().total() <= start + 1e-3);
      }
    }
  }
}

TEST_CASE("lanes follow the reference in double") {
  for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
    for (const SceneDescription& scene : all_kinds()) {
      Settings settings = small_steps(0.5);  // no local passes, whose choices differ by rounding
      settings.scheme = scheme;
      settings.substeps = 12;
      Cloth lanes = cloth_of(scene, settings);
      settings.backend = Backend::reference;
      Cloth reference = cloth_of(scene, settings);
      run(lanes, 0.01, 10);
      run(reference, 0.01, 10);
      CAPTURE(scene.constraints.size());
      CAPTURE(name(scheme));
      CHECK(largest_distance(positions(lanes), positions(reference)) < 2e-5);
      CHECK(largest_distance(velocities(lanes), velocities(reference)) < 5e-3);
    }
  }
}

TEST_CASE("free flight is exact, from the first substep on and across frames of any length") {
  SceneDescription scene = free_bar(1, 2);
  scene.gravity = {0, -10, 0};
  scene.velocities = {{1, 2, 0.5}, {1, 2, 0.5}};
  for (const Backend backend : kBackends) {
    Settings settings = small_steps();
    settings.backend = backend;
    settings.substeps = 5;
    Cloth cloth = cloth_of(scene, settings);
    double t = 0;
    for (const double dt : {0.01, 0.013, 0.008, 0.016, 0.01}) {
      REQUIRE(step(cloth, dt).status == Status::converged);
      t += dt;
    }
    const Vec3 x = cloth.position(0), v = cloth.velocity(0);
    CHECK(x.x == doctest::Approx(scene.positions[0].x + t).epsilon(1e-6));
    CHECK(std::abs(x.y - (scene.positions[0].y + 2 * t - 5 * t * t)) < 1e-6);
    CHECK(std::abs(v.y - (2 - 10 * t)) < 2e-5);
  }
}

/// The distance of a swinging sheet from one in eight times as many substeps.
double error_of(const SceneDescription& scene, Scheme scheme, int substeps) {
  const auto swung = [&](int n) {
    Settings settings = small_steps(0.5);
    settings.backend = Backend::reference;
    settings.scheme = scheme;
    settings.substeps = n;
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 0.01, 20);
    return positions(cloth);
  };
  return largest_distance(swung(substeps), swung(16 * substeps));
}

TEST_CASE("bdf2 is second order, implicit first") {
  const SceneDescription scene = scene_of("hang", 10);
  const double second = error_of(scene, Scheme::bdf2, 4) / error_of(scene, Scheme::bdf2, 8);
  const double first = error_of(scene, Scheme::implicit, 4) / error_of(scene, Scheme::implicit, 8);
  CHECK(second > 3.3);
  CHECK(second < 4.8);
  CHECK(first > 1.7);
  CHECK(first < 2.4);
}

TEST_CASE("any number of threads, AVX2 or AVX-512: the same bits") {
  for (const SceneDescription& scene : {make("cape", {.size = 70}), make("corners", {.size = 61}),
                                        make("four_pins", {.size = 61, .diagonals = true})}) {
    Settings settings = small_steps();
    Cloth one = cloth_of(scene, settings);
    settings.threads = 4;
    Cloth four = cloth_of(scene, settings);
    run(one, 0.01, 4);
    run(four, 0.01, 4);
    CHECK(one.state_hash() == four.state_hash());
    settings.isa = Isa::avx2;
    if (auto narrow = Cloth::create(model_of(scene), settings);
        narrow && one.settings().isa == Isa::avx512) {
      run(narrow.value(), 0.01, 4);
      CHECK(one.state_hash() == narrow.value().state_hash());
    }
  }
}

TEST_CASE("a clone goes on bit for bit") {
  for (const Backend backend : kBackends) {
    for (const SceneDescription& scene : all_kinds()) {
      Settings settings = small_steps();
      settings.backend = backend;
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 7);
      Cloth copy = cloth.clone();
      run(cloth, 0.01, 9);
      run(copy, 0.01, 9);
      CHECK(cloth.state_hash() == copy.state_hash());
    }
  }
}

TEST_CASE("frames of random length keep tolerance and energy") {
  for (const SceneDescription& scene : all_kinds()) {
    Cloth cloth = cloth_of(scene, small_steps());
    Random random(3);
    const double start = cloth.energy().total();
    for (int frame = 0; frame < 150; ++frame) {
      const StepReport report = step(cloth, random.between(0.014, 0.02));
      REQUIRE(report.status == Status::converged);
      REQUIRE(cloth.energy().total() <= start + 1e-3);
    }
  }
}

TEST_CASE("pins under way do the work that the cloth gains, and no more of it appears") {
  const SceneDescription scene = make("hang", {.size = 20, .diagonals = true});
  Cloth cloth = cloth_of(scene, small_steps());
  const double start = cloth.energy().total();
  double work = 0;
  for (int frame = 1; frame <= 120; ++frame) {
    const double shift = 0.2 * (1 - std::cos(2 * 3.14159265 * frame / 60));
    for (const std::uint32_t pin : scene.fixed) {
      Vec3 to = scene.positions[pin];
      to.x += shift;
      REQUIRE(cloth.move_fixed(pin, to));
    }
    const StepReport report = step(cloth, 1. / 60);
    REQUIRE(report.status == Status::converged);
    work += report.pin_work;
    REQUIRE(cloth.energy().total() <= start + work + 1e-3);
    for (const std::uint32_t pin : scene.fixed) {
      REQUIRE(cloth.position(pin).x == scene.positions[pin].x + shift);
    }
  }
}

TEST_CASE("with a given number of substeps work is bounded, and a miss is told") {
  SceneDescription scene = make("four_pins", {.size = 21});
  Settings settings = small_steps(0.001);
  settings.substeps = 2;
  Cloth cloth = cloth_of(scene, settings);
  bool missed = false;
  const double start = cloth.energy().total();
  for (int frame = 0; frame < 40; ++frame) {
    const StepReport report = step(cloth, 0.01);
    CHECK(report.substeps == 2);
    CHECK(report.iterations <= (2 + 1) * (2 + tuning::kMostVisits));
    CHECK((report.status == Status::converged) == (report.max_strain <= 0.001));
    missed |= report.status != Status::converged;
    CHECK(cloth.energy().total() <= start + 1e-3);
  }
  CHECK(missed);
}

TEST_CASE("a number of iterations is a number of sweeps") {
  Settings settings = small_steps();
  settings.substeps = 4;
  settings.iterations = 3;
  Cloth cloth = cloth_of(scene_of("corners", 21), settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::fixed_iterations);
  CHECK(report.iterations == 12);
  CHECK(report.substeps == 4);
}

TEST_CASE("a substep's length: shorter under a load, on taut spans, for tight tolerances") {
  const auto length_for = [](const SceneDescription& scene, double tolerance) {
    const auto model = model_of(scene);
    kernels::Vectors x = model->initial_position;
    return substep_length(model->small_steps().load, x.view(), {.acceleration = 10}, tolerance);
  };
  const SceneDescription corners = make("corners", {.size = 21});
  CHECK(length_for(corners, 0.01) / length_for(corners, 0.0025) ==
        doctest::Approx(2).epsilon(0.05));
  CHECK(length_for(make("four_pins", {.size = 21}), 0.01) < length_for(corners, 0.01));
  CHECK(length_for(make("corners", {.size = 41}), 0.01) < 0.8 * length_for(corners, 0.01));
  // One edge that carries n particles: omega epsilon L / (6 g n), within what depth and means do.
  const double cape = length_for(make("cape", {.size = 120}), 0.01);
  CHECK(0.01 / cape > 80);
  CHECK(0.01 / cape < 128);
}

TEST_CASE("yarns are blocks where they are long, and edges elsewhere") {
  CHECK(model_of(make("hang", {.size = 20}))->small_steps().blocks.empty());
  CHECK(model_of(make("hang", {.size = 20}))->small_steps().has_yarns());
  const auto braced = model_of(make("hang", {.size = 20, .diagonals = true}));
  CHECK(braced->small_steps().has_yarns());
  CHECK_FALSE(braced->small_steps().blocks.empty());
  CHECK_FALSE(model_of(make("cape", {.size = 40}))->small_steps().has_yarns());
}

TEST_CASE("small steps take their own schemes and no velocity loop, and say so") {
  const auto model = model_of(scene_of("hang", 5));
  Settings settings = small_steps();
  CHECK(Cloth::create(model, settings).value().settings().scheme == Scheme::bdf2);
  settings.scheme = Scheme::rattle;
  CHECK(Cloth::create(model, settings).error() ==
        "scheme: solver small_steps takes implicit and bdf2 (rattle)");
  settings = small_steps();
  settings.velocity_correction = true;
  CHECK(Cloth::create(model, settings).error() ==
        "velocity_correction: small steps have no velocity loop (on)");
  settings = {};
  settings.solver = Solver::yarn;
  settings.scheme = Scheme::bdf2;
  CHECK(Cloth::create(model, settings).error() ==
        "scheme: is for solver small_steps, not yarn (bdf2)");
}

TEST_CASE("cloth that no pin holds has the load of what may hang over a sphere") {
  SceneDescription scene = make("hang_sphere", {.size = 21});
  const std::uint32_t sphere = scene.spheres[0];
  const auto load_of = [](const SceneDescription& described) {
    const auto model = model_of(described);
    return model->small_steps().load;
  };
  const double pinned = load_of(scene).particles;
  scene.fixed = {sphere};
  const SmallStepsLoad over_sphere = load_of(scene);
  // Across a grid of 20 x 20 cells it is 40 constraints from corner to corner.
  CHECK(over_sphere.particles == 20 - 1);
  CHECK(over_sphere.reach == doctest::Approx(1));
  CHECK(pinned > 0);
  scene.spheres.clear();
  scene.radii.clear();
  const SmallStepsLoad free = load_of(scene);
  CHECK(free.particles <= 0);
  CHECK(free.reach == 0);
}

/// Ropes from every particle to its pin above it.
SceneDescription tethered(SceneDescription scene, std::uint32_t columns) {
  for (std::uint32_t i = 2 * columns; i < scene.positions.size(); ++i) {
    const std::uint32_t pin = i % columns;
    scene.constraints.push_back(
        {pin, i, distance(scene.positions[i], scene.positions[pin]), ConstraintKind::rope});
  }
  return scene;
}

TEST_CASE(
    "ropes to pins change neither the size of what hangs without them, nor how far it reaches, nor "
    "what its yarns carry") {
  for (const bool diagonals : {false, true}) {
    const SceneDescription scene = make("hang", {.size = 21, .diagonals = diagonals});
    const SmallStepsLoad load = model_of(scene)->small_steps().load;
    const SmallStepsLoad with_ropes = model_of(tethered(scene, 21))->small_steps().load;
    CHECK(with_ropes.mean_length == doctest::Approx(load.mean_length));
    CHECK(with_ropes.reach == doctest::Approx(load.reach));
    CHECK(with_ropes.particles == doctest::Approx(load.particles));
    CHECK(with_ropes.held_mass == doctest::Approx(load.held_mass));
  }
}

TEST_CASE("the ways between pins are the shortest along rigid constraints and ropes") {
  const auto model = model_of(make("four_pins", {.size = 21}));
  const std::vector<SmallStepsLoad::Span>& ways = model->small_steps().load.ways;
  CHECK(ways.size() >= 4);
  for (const SmallStepsLoad::Span& way : ways) {
    const kernels::Vector d =
        model->initial_position[way.first_slot] - model->initial_position[way.last_slot];
    CHECK(way.length == doctest::Approx(std::abs(d.x) + std::abs(d.y) + std::abs(d.z)));
  }
  CHECK(model_of(make("flag", {.size = 21}))->small_steps().load.ways.empty());
}

TEST_CASE("a sphere that lies on a cloth asks for shorter substeps") {
  const auto model = model_of(make("four_pins", {.size = 21}));
  kernels::Vectors x = model->initial_position;
  const auto length_under = [&](double mass) {
    return substep_length(model->small_steps().load, x.view(), {.acceleration = 10, .mass = mass},
                          0.01);
  };
  CHECK(length_under(1) < 0.9 * length_under(0));
  CHECK(length_under(100) / length_under(400) == doctest::Approx(2).epsilon(0.1));
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_small_steps
