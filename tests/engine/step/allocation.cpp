/// A step allocates nothing once warm.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_step_allocation {
namespace {

/// The allocations of the second of two equal runs of 200 steps.
std::size_t allocations_when_warm(const SceneDescription& scene, const Settings& settings) {
  const std::vector<Vec3> at_rest(scene.positions.size());
  Cloth cloth = cloth_of(scene, settings);
  const auto run_200 = [&cloth] {
    std::size_t failed = 0;
    for (int k = 0; k < 200; ++k) failed += !cloth.step(0.01);
    return failed;
  };
  REQUIRE(run_200() == 0);
  const std::uint64_t end = cloth.state_hash();
  REQUIRE(cloth.write_positions(scene.positions));
  REQUIRE(cloth.write_velocities(at_rest));
  const std::size_t before = allocations();
  const std::size_t failed = run_200();
  const std::size_t after = allocations();
  REQUIRE(failed == 0);
  REQUIRE(cloth.state_hash() == end);
  return after - before;
}

std::size_t allocations_when_warm(const char* name, const Settings& settings) {
  return allocations_when_warm(scene_of(name, 7), settings);
}

TEST_CASE("the counter counts") {
  const std::size_t before = allocations();
  const auto kept = std::make_unique<std::vector<int>>(100);
  CHECK(kept->size() == 100);
  CHECK(allocations() - before == 2);
}

TEST_CASE("a warm step allocates nothing") {
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    for (const Method& method : kAllMethods) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(name));
        CAPTURE(text(method));
        CAPTURE(velocity_correction);
        Settings settings = with(paper_settings(), method);
        settings.velocity_correction = velocity_correction;
        CHECK(allocations_when_warm(name, settings) == 0);
      }
    }
  }
}

TEST_CASE("nor does a warm step through products") {
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(std::string(name));
      CAPTURE(velocity_correction);
      Settings settings = paper_settings();
      settings.measuring.anticipate_products = true;
      settings.velocity_correction = velocity_correction;
      CHECK(allocations_when_warm(name, settings) == 0);
    }
  }
}

TEST_CASE("nor does a warm step whose motion is held") {
  for (const char* name : {"hang", "hang_sphere", "corners"}) {
    Settings settings;
    settings.motion_tolerance = 0.003;
    CAPTURE(std::string(name));
    CHECK(allocations_when_warm(name, settings) == 0);
  }
}

TEST_CASE("nor does a warm step by yarns") {
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(name));
        CAPTURE(weft::name(scheme));
        CAPTURE(velocity_correction);
        Settings settings;
        settings.solver = Solver::yarn;
        settings.scheme = scheme;
        settings.velocity_correction = velocity_correction;
        CHECK(allocations_when_warm(name, settings) == 0);
      }
    }
  }
}

TEST_CASE("nor does a warm step of springs") {
  for (const char* name : {"hang", "hang_sphere", "corners"}) {
    SceneDescription scene = scene_of(name, 7);
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
      scene.constraints[i].compliance = 1e-4 * static_cast<double>(i % 3);
    }
    scene.damping.stretch = 0.001;
    for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
      for (const Backend backend : kBackends) {
        if (solver == Solver::yarn && backend == Backend::reference) continue;
        CAPTURE(std::string(name));
        CAPTURE(weft::name(solver));
        CHECK(allocations_when_warm(scene, {.solver = solver, .backend = backend}) == 0);
      }
    }
  }
}

TEST_CASE("nor does a warm step by small steps, nor without contacts the first") {
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners", "four_pins", "cape"}) {
    for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
      CAPTURE(std::string(name));
      CAPTURE(weft::name(scheme));
      const SceneDescription scene = scene_of(name, 9);
      Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .scheme = scheme});
      const std::size_t start = allocations();
      const auto first = cloth.step(0.01);
      if (scene.spheres.empty()) CHECK(allocations() == start);
      REQUIRE(first);
      for (int k = 0; k < 200; ++k) REQUIRE(cloth.step(0.01));
      REQUIRE(cloth.write_positions(scene.positions));
      REQUIRE(cloth.write_velocities(std::vector<Vec3>(scene.positions.size())));
      const std::size_t before = allocations();
      std::size_t failed = 0;
      for (int k = 0; k < 200; ++k) failed += !cloth.step(0.01);
      const std::size_t after = allocations();
      CHECK(failed == 0);
      CHECK(after == before);
    }
  }
}

TEST_CASE("nor does a step in air, of motion that decays") {
  for (const Solver solver :
       {Solver::gauss_seidel, Solver::yarn, Solver::direct, Solver::small_steps}) {
    CAPTURE(name(solver));
    SceneDescription scene = scene_of("hang", 7);
    for (std::uint32_t i = 0; i < 41; ++i) scene.air.triangles.push_back({i, i + 1, i + 7});
    scene.air.drag = scene.air.lift = scene.damping.motion = 1;
    Cloth cloth = cloth_of(scene, {.solver = solver});
    const std::size_t before = allocations();
    const auto report = cloth.step(0.01);
    const std::size_t after = allocations();
    CHECK(report);
    CHECK(after == before);
  }
}

TEST_CASE("nor does a step under pressures, of gas and of wind that is caught") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = scene_of("hang", 7);
    for (std::uint32_t i = 0; i < 41; ++i) scene.air.triangles.push_back({i, i + 1, i + 7});
    scene.air.ram = 1;
    scene.surface = {{10, 11, 17}, {10, 18, 11}, {11, 18, 17}, {17, 18, 10}};  // of no volume
    scene.pressures = {{.pressure = 3, .triangles = {1}},
                       {.pressure = 2, .gas = true, .volume = 1, .ambient = 1e-3}};
    Cloth cloth = cloth_of(scene, on(backend, {.solver = Solver::small_steps}));
    std::size_t failed = 0;
    const std::size_t before = allocations();
    for (int k = 0; k < 20; ++k) {
      failed += !cloth.step(0.01);
      failed += !cloth.set_wind({0.1 * k, 3, 0});
    }
    const std::size_t after = allocations();
    CHECK(failed == 0);
    if (backend == Backend::simd) CHECK(after == before);
  }
}

TEST_CASE("nor does a warm step with bending elements, nor the first") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = with_rows(scene_of("corners", 9), 9, 1e-4);
    scene.damping.bending = 0.01;
    Cloth cloth = cloth_of(scene, on(backend, {.solver = Solver::small_steps}));
    std::size_t failed = 0;
    const std::size_t before = allocations();
    for (int k = 0; k < 20; ++k) failed += !cloth.step(0.01);
    const std::size_t after = allocations();
    CHECK(failed == 0);
    if (backend == Backend::simd) CHECK(after == before);
  }
}

TEST_CASE("nor does a step with anchors, nor their moving, nor carrying the cloth") {
  for (const char* name : {"corners", "cape"}) {
    SceneDescription scene = scene_of(name, 9);
    std::vector<Vec3> points;
    for (std::uint32_t i = 20; i < 70; ++i) {
      if (std::ranges::find(scene.fixed, i) != scene.fixed.end()) continue;
      points.push_back(scene.positions[i]);
      scene.anchors.push_back({.particle = i,
                               .point = points.back(),
                               .normal = {0, 1, 0},
                               .max_distance = 0.02,
                               .backstop_radius = 1});
    }
    Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps});
    step(cloth, 0.01);
    std::size_t failed = 0;
    const std::size_t before = allocations();
    for (int k = 0; k < 40; ++k) {
      for (Vec3& point : points) point.x += 0.002;
      failed += !cloth.move_anchors(points);
      failed += !cloth.carry({.translation = {0.001, 0, 0}}, 0.5);
      failed += !cloth.step(0.01);
    }
    const std::size_t after = allocations();
    CHECK(failed == 0);
    CHECK(after == before);
  }
}

TEST_CASE("without contacts even the first step allocates nothing") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(scene_of("hang", 7), with(paper_settings(), method));
    const std::size_t before = allocations();
    const auto report = cloth.step(0.01);
    const std::size_t after = allocations();
    CHECK(report);
    CHECK(after == before);
  }
}

TEST_CASE("without contacts no step of yarns does, however late it first wants a linear system") {
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    CAPTURE(name(scheme));
    Cloth cloth = cloth_of(scene_of("corners", 31), {.scheme = scheme});
    const std::size_t before = allocations();
    std::int64_t iterations = 0;
    for (int k = 0; k < 60; ++k)
      iterations = std::max(iterations, cloth.step(0.01).value().iterations);
    const std::size_t after = allocations();
    CHECK(iterations > 20);  // conjugate gradients
    CHECK(after == before);
  }
}

TEST_CASE("without contacts no step of ropes in a row does, however many there are") {
  for (const std::uint32_t links : {10u, 9000u}) {
    CAPTURE(links);
    SceneDescription scene;
    for (std::uint32_t i = 0; i <= links; ++i) {
      scene.positions.push_back({0.01 * i, 0, 0});
      if (i > 0) scene.constraints.push_back({i - 1, i, 0.01, ConstraintKind::rope});
    }
    scene.masses.assign(links + 1, 0.01);
    scene.fixed = {0};
    Cloth cloth = cloth_of(scene, {});
    REQUIRE(cloth.settings().solver == Solver::small_steps);
    const std::size_t before = allocations();
    std::size_t failed = 0;
    for (int k = 0; k < 3; ++k) failed += !cloth.step(0.01);
    const std::size_t after = allocations();
    CHECK(failed == 0);
    CHECK(after == before);
  }
}

TEST_CASE("nor does a step that begins with a projection") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const SceneDescription scene = scene_of("hang", 7);
    Cloth cloth = cloth_of(scene, with(paper_settings(), method));
    std::vector<Vec3> stretched = scene.positions;
    for (Vec3& x : stretched) x.y += 0.1 * x.x;
    REQUIRE(cloth.write_positions(stretched));
    const std::size_t before = allocations();
    const auto report = cloth.step(0.01);
    const std::size_t after = allocations();
    CHECK(report);
    CHECK(after == before);
  }
}

TEST_CASE("nor does a warm step that two threads share") {
  tbb::task_arena arena(2);
  arena.execute([] {
    for (const Solver solver : {Solver::yarn, Solver::small_steps}) {
      CAPTURE(name(solver));
      Cloth cloth = cloth_of(scene_of("hang", 45), {.solver = solver});
      run(cloth, 0.005, 20);
      const std::size_t before = allocations();
      for (int k = 0; k < 20; ++k) (void)cloth.step(0.005);
      const std::size_t after = allocations();
      CHECK(after == before);
    }
  });
}

}  // namespace
}  // namespace weft::test::engine_step_allocation
