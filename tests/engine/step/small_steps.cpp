/// What weft.h promises of every step, by small steps of both schemes.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"
#include "tools/scenes/scenes.h"

namespace weft::test::engine_step_small_steps {
namespace {

constexpr Scheme kSchemes[] = {Scheme::implicit, Scheme::bdf2};

Settings small_steps(Scheme scheme, double tolerance = 0.01) {
  return {.tolerance = tolerance, .solver = Solver::small_steps, .scheme = scheme};
}

SceneDescription roped_cape(int size) {
  scenes::Options options;
  options.size = size;
  options.ropes = true;
  return scenes::make("cape", options).value();
}

/// Woven sheets, triangles, ropes, hubs and spheres; one and several tiles.
std::vector<NamedScene> all_scenes() {
  return {{"hang, 20", scene_of("hang", 20)},
          {"hang, 90", scene_of("hang", 90)},
          {"corners, 41", scene_of("corners", 41)},
          {"four_pins, 21", scene_of("four_pins", 21)},
          {"hang_sphere, 41", scene_of("hang_sphere", 41)},
          {"cape of ropes, 40", roped_cape(40)},
          {"ropes, 70", roped_sheet(70)},
          {"random mesh, 41", random_sheet(41, 5)},
          {"hub, 33", hub_sheet(33)}};
}

template <class F>
void for_all(F f) {
  for (const NamedScene& scene : all_scenes()) {
    for (const Scheme scheme : kSchemes) {
      CAPTURE(scene.name);
      CAPTURE(std::string(name(scheme)));
      f(scene.scene, small_steps(scheme));
    }
  }
}

std::uint64_t hash_after(const SceneDescription& scene, const Settings& settings, int threads) {
  tbb::task_arena arena(threads);
  return arena.execute([&] {
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 0.005, 6);
    return cloth.state_hash();
  });
}

TEST_CASE("the number of threads changes no bit") {
  for_all([](const SceneDescription& scene, Settings settings) {
    settings.threads = 1;
    const std::uint64_t alone = hash_after(scene, settings, 1);
    CHECK(hash_after(scene, settings, 2) == alone);
    settings.threads = 0;
    CHECK(hash_after(scene, settings, 2) == alone);
    CHECK(hash_after(scene, settings, 3) == alone);
  });
}

TEST_CASE("AVX2 and AVX-512 give the same bits, SSE2 about the same motion") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  for_all([](const SceneDescription& scene, Settings settings) {
    settings.isa = Isa::avx2;
    const std::uint64_t narrow = hash_after(scene, settings, 1);
    settings.isa = Isa::avx512;
    CHECK(hash_after(scene, settings, 1) == narrow);
    settings.isa = Isa::sse2;
    CHECK(hash_after(scene, settings, 1) != narrow);
  });
}

TEST_CASE("a clone goes on bit for bit, and so does a cloth that takes over the state") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings);
    auto other = Cloth::create(cloth.model(), settings);
    REQUIRE(other);
    for (int k = 0; k < 3; ++k) {
      run(cloth, 0.01, 3);
      Cloth clone = cloth.clone();
      REQUIRE(other.value().copy_state(cloth));
      for (Cloth* each : {&cloth, &clone, &other.value()}) run(*each, 0.007, 3);
      CHECK(clone.state_hash() == cloth.state_hash());
      CHECK(other.value().state_hash() == cloth.state_hash());
    }
  });
}

TEST_CASE("a step that is refused changes nothing, and the next goes on as if it had not been") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings), undisturbed = cloth_of(scene, settings);
    const std::vector<Vec3> pull(scene.positions.size(), Vec3{1e300, 1e300, 0});
    for (int k = 0; k < 3; ++k) {
      run(cloth, 0.01, 2);
      run(undisturbed, 0.01, 2);
      const std::uint64_t before = cloth.state_hash();
      REQUIRE(cloth.write_forces(pull));
      const StepReport report = step(cloth, 0.01);
      CHECK_FALSE(committed(report.status));
      CHECK(cloth.state_hash() == before);
      REQUIRE(cloth.write_forces({}));
      REQUIRE(cloth.state_hash() == undisturbed.state_hash());
    }
  });
}

TEST_CASE("positions and velocities that are written have no past") {
  for_all([](const SceneDescription& scene, const Settings& settings) {
    Cloth used = cloth_of(scene, settings), fresh = cloth_of(scene, settings);
    run(used, 0.01, 5);
    REQUIRE(used.write_positions(scene.positions));
    REQUIRE(used.write_velocities(std::vector<Vec3>(scene.positions.size())));
    run(used, 0.01, 2);
    run(fresh, 0.01, 2);
    CHECK(used.state_hash() == fresh.state_hash());
  });
}

TEST_CASE("each frame is within its tolerance, and none gains energy") {
  for (const char* name : {"hang", "hang_sphere", "corners", "four_pins", "banner", "cape"}) {
    for (const Scheme scheme : kSchemes) {
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        for (const double dt : {1. / 60, 1. / 240}) {
          for (const int substeps : {kAutomaticSubsteps, 8}) {
            CAPTURE(std::string(name));
            CAPTURE(std::string(weft::name(scheme)));
            CAPTURE(tolerance);
            CAPTURE(dt);
            CAPTURE(substeps);
            Settings settings = small_steps(scheme, tolerance);
            settings.substeps = substeps;
            Cloth cloth = cloth_of(scene_of(name, 13), settings);
            const double start = cloth.energy().total();
            double most = start;
            for (int k = 0; k < 60; ++k) {
              const StepReport report = step(cloth, dt);
              most = std::max(most, cloth.energy().total());
              if (report.status != Status::converged) continue;
              CHECK(report.max_strain <= tolerance * (1 + 1e-6));
              CHECK(report.max_penetration <= settings.contact_tolerance * (1 + 1e-6));
            }
            CHECK(most - start < 0.001);
          }
        }
      }
    }
  }
}

TEST_CASE("with substeps that are chosen every frame converges") {
  for (const char* name : {"hang", "hang_sphere", "corners", "four_pins", "banner", "cape"}) {
    for (const Scheme scheme : kSchemes) {
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        CAPTURE(std::string(name));
        CAPTURE(std::string(weft::name(scheme)));
        CAPTURE(tolerance);
        const bool locks = std::string_view(name) == "cape" && tolerance < 0.01;  // rigid triangles
        if (locks) continue;
        Cloth cloth = cloth_of(scene_of(name, 13), small_steps(scheme, tolerance));
        for (int k = 0; k < 120; ++k) REQUIRE(step(cloth, 1. / 60).status == Status::converged);
      }
    }
  }
}

TEST_CASE("a sheet in free flight keeps its momentum, as far as floats do") {
  SceneDescription scene = scene_of("hang", 12);
  scene.fixed.clear();
  scene.gravity = {0, 0, 0};
  for (const Vec3 at : scene.positions) scene.velocities.push_back({3 + at.z, 1, 2 - at.x});
  const Vec3 before = momentum(scene.masses, scene.velocities);
  for (const Scheme scheme : kSchemes) {
    CAPTURE(std::string(name(scheme)));
    Cloth cloth = cloth_of(scene, small_steps(scheme));
    run(cloth, 0.01, 200);
    const Vec3 lost = momentum(scene.masses, velocities(cloth)) - before;
    CHECK(length(lost) < 1e-5 * length(before));
  }
}

TEST_CASE("what is carried along by its pins moves as what is at rest") {
  const SceneDescription at_rest = scene_of("hang", 13);
  constexpr double kFrame = 1. / 60;
  const Vec3 speed{0, 0, 2};
  for (const Scheme scheme : kSchemes) {
    CAPTURE(std::string(name(scheme)));
    SceneDescription scene = at_rest;
    scene.velocities.assign(scene.positions.size(), speed);
    for (const std::uint32_t pin : scene.fixed) scene.velocities[pin] = {};
    Cloth cloth = cloth_of(scene, small_steps(scheme));
    Cloth still = cloth_of(at_rest, small_steps(scheme));
    for (int k = 1; k <= 60; ++k) {
      const Vec3 travelled = k * kFrame * speed;
      for (const std::uint32_t pin : scene.fixed) {
        REQUIRE(cloth.move_fixed(pin, scene.positions[pin] + travelled));
      }
      REQUIRE(step(cloth, kFrame).status == Status::converged);
      REQUIRE(step(still, kFrame).status == Status::converged);
      std::vector<Vec3> seen = positions(cloth);
      for (Vec3& p : seen) p = p - travelled;
      CHECK(largest_distance(seen, positions(still)) < 1e-3);
    }
  }
}

double fastest(const Cloth& cloth) {
  double speed = 0;
  for (const Vec3 v : velocities(cloth)) speed = std::max(speed, length(v));
  return speed;
}

TEST_CASE("pins that are placed elsewhere move a cloth without making it fast") {
  const SceneDescription scene = scene_of("hang", 13);
  for (const Scheme scheme : kSchemes) {
    CAPTURE(std::string(name(scheme)));
    Cloth cloth = cloth_of(scene, small_steps(scheme));
    run(cloth, 1. / 60, 10);
    const double before = fastest(cloth);
    for (const std::uint32_t pin : scene.fixed) {
      REQUIRE(cloth.place_fixed(pin, scene.positions[pin] + Vec3{0, 0.05, 0.2}));
    }
    run(cloth, 1. / 60, 2);
    CHECK(fastest(cloth) < before + 1);
  }
}

TEST_CASE("a cloth at rest stays at rest through frames of any length, and gains nothing") {
  for (const Scheme scheme : kSchemes) {
    CAPTURE(std::string(name(scheme)));
    SceneDescription scene = scene_of("hang", 13);
    for (Vec3& p : scene.positions) p = {0, -p.x, p.z};  // a curtain
    Cloth cloth = cloth_of(scene, small_steps(scheme));
    run(cloth, 1. / 60, 60);
    const std::vector<Vec3> before = positions(cloth);
    const double energy = cloth.energy().total();
    for (const double dt : {1. / 600, 1. / 60, 1e-5, 1. / 60, 1. / 10, 1. / 240}) {
      CAPTURE(dt);
      CHECK(step(cloth, dt).status == Status::converged);
      CHECK(largest_distance(positions(cloth), before) < 0.01);
      CHECK(cloth.energy().total() < energy + 0.001);
    }
  }
}

TEST_CASE("a far shorter step in between changes a motion as little as it is long") {
  for (const Scheme scheme : kSchemes) {
    for (const double in_between : {1. / 600, 1e-4, 1e-5}) {
      CAPTURE(std::string(name(scheme)));
      CAPTURE(in_between);
      Cloth cloth = cloth_of(scene_of("hang", 13), small_steps(scheme));
      run(cloth, 1. / 60, 20);
      Cloth undisturbed = cloth.clone();
      step(cloth, in_between);
      run(cloth, 1. / 60, 3);
      run(undisturbed, 1. / 60, 3);
      const double way = in_between * fastest(undisturbed);
      CHECK(largest_distance(positions(cloth), positions(undisturbed)) < 2 * way + 0.005);
    }
  }
}

TEST_CASE("schemes and solvers that do not go together are refused") {
  const auto model = model_of(scene_of("hang", 5));
  const auto error = [&](const Settings& settings) {
    return Cloth::create(model, settings).error();
  };
  CHECK(error({.solver = Solver::small_steps, .scheme = Scheme::paper}) ==
        "scheme: solver small_steps takes implicit and bdf2 (paper)");
  CHECK(error({.solver = Solver::small_steps, .scheme = Scheme::rattle}) ==
        "scheme: solver small_steps takes implicit and bdf2 (rattle)");
  CHECK(error({.solver = Solver::yarn, .scheme = Scheme::bdf2}) ==
        "scheme: is for solver small_steps, not yarn (bdf2)");
  CHECK(error({.solver = Solver::small_steps, .velocity_correction = true}) ==
        "velocity_correction: small steps have no velocity loop (on)");
}

TEST_CASE(
    "a fold that runs through long yarns at a tight tolerance leaves little to local passes") {
  Cloth cloth = cloth_of(scene_of("hang", 200), small_steps(Scheme::bdf2, 0.001));
  for (int frame = 0; frame < 46; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(static_cast<double>(report.iterations) < 2.5 * report.substeps);
  }
}

SceneDescription with_free_sphere(SceneDescription scene, Vec3 at, double mass) {
  scene.spheres = {static_cast<std::uint32_t>(scene.positions.size())};
  scene.radii.assign(scene.positions.size(), 0);
  scene.positions.push_back(at);
  scene.masses.push_back(mass);
  scene.radii.push_back(0.2);
  if (!scene.velocities.empty()) scene.velocities.push_back({0, 0, 0});
  return scene;
}

TEST_CASE("a free sphere that is far away changes no bit of a sheet") {
  for (const char* name : {"hang", "corners"}) {
    CAPTURE(std::string(name));
    const SceneDescription scene = scene_of(name, 21);
    Cloth alone = cloth_of(scene, {});
    Cloth with_sphere = cloth_of(with_free_sphere(scene, {100, 0, 0}, 5), {});
    REQUIRE(with_sphere.settings().solver == alone.settings().solver);
    for (int k = 0; k < 40; ++k) {
      CHECK(step(alone, 1. / 60).status == step(with_sphere, 1. / 60).status);
      std::vector<Vec3> x = positions(with_sphere);
      x.pop_back();
      CHECK(largest_distance(positions(alone), x) == 0);
    }
  }
}

TEST_CASE("the way of a free sphere decides whether it matters to the choice of a solver") {
  const auto solver_with = [](Vec3 at, Vec3 velocity, double mass) {
    SceneDescription scene = with_free_sphere(scene_of("corners", 21), at, mass);
    scene.velocities.assign(scene.positions.size(), {0, 0, 0});
    scene.velocities.back() = velocity;
    return cloth_of(scene, {}).settings().solver;
  };
  CHECK(solver_with({0.5, 20, 0.5}, {0, 0, 0}, 5) == Solver::yarn);           // falls onto it
  CHECK(solver_with({0.5, 20, 0.5}, {8, 0, 0}, 5) == Solver::small_steps);    // falls beside it
  CHECK(solver_with({-20, 0, 0.5}, {20, 5, 0}, 5) == Solver::yarn);           // is thrown at it
  CHECK(solver_with({-20, 0, 0.5}, {20, 50, 0}, 5) == Solver::small_steps);   // and over it
  CHECK(solver_with({0.5, 1, 0.5}, {0, 0, 0}, 0.01) == Solver::small_steps);  // is light
}

}  // namespace
}  // namespace weft::test::engine_step_small_steps
