/// Cloth that has anchors: the same bits, copies, failed steps, substeps, and refusals.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/anchored.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_anchored_cloth {
namespace {

using namespace anchored;

/// Anchors that have all kinds of limits, on a woven sheet, on triangles, and among springs.
std::vector<SceneDescription> anchored_scenes(int size) {
  std::vector<SceneDescription> scenes{scene_of("hang", size), scene_of("cape", size),
                                       scene_of("corners", size)};
  for (Constraint& c : scenes[2].constraints) c.compliance = 1e-5;
  for (SceneDescription& scene : scenes) {
    anchor_all(scene, 0.05);
    for (std::size_t i = 0; i < scene.anchors.size(); i += 2) {
      scene.anchors[i].normal = {0, 0.6, 0.8};
      scene.anchors[i].max_distance = i % 3 == 0 ? 0.02 : kInfinity;
      scene.anchors[i].backstop_distance = 0.01;
      scene.anchors[i].backstop_radius = i % 4 == 0 ? 0.1 : 1;
    }
    std::erase_if(scene.anchors, [](const Anchor& anchor) { return anchor.particle % 11 == 0; });
  }
  return scenes;
}

std::vector<Vec3> shifted(std::vector<Vec3> points, double by) {
  for (Vec3& point : points) point = point + Vec3{by, 0, 0.5 * by};
  return points;
}

std::uint64_t hash_after(const SceneDescription& scene, const Settings& settings, int threads) {
  tbb::task_arena arena(threads);
  return arena.execute([&] {
    Cloth cloth = cloth_of(scene, settings);
    for (int frame = 1; frame <= 6; ++frame) {
      REQUIRE(cloth.move_anchors(shifted(points_of(scene), 0.003 * frame)));
      step(cloth, 0.005);
    }
    return cloth.state_hash();
  });
}

TEST_CASE("anchored cloth has the same bits on any number of threads, and on AVX2 and AVX-512") {
  for (const SceneDescription& scene : anchored_scenes(51)) {
    Settings settings{.isa = Isa::avx2, .threads = 1};
    const std::uint64_t alone = hash_after(scene, settings, 1);
    settings.threads = 0;
    CHECK(hash_after(scene, settings, 2) == alone);
    CHECK(hash_after(scene, settings, 3) == alone);
    settings.isa = Isa::avx512;
    if (simd::supported(simd::Isa::avx512)) CHECK(hash_after(scene, settings, 1) == alone);
  }
}

TEST_CASE("anchored cloth moves alike in lanes and in double") {
  for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
    for (const SceneDescription& scene : anchored_scenes(15)) {
      Settings settings = small_steps(Backend::simd, 12);
      settings.iterations = 1;  // no local passes, whose choices differ by rounding
      settings.scheme = scheme;
      Cloth lanes = cloth_of(scene, settings);
      settings.backend = Backend::reference;
      Cloth reference = cloth_of(scene, settings);
      for (int frame = 1; frame <= 7; ++frame) {
        for (Cloth* cloth : {&lanes, &reference}) {
          REQUIRE(cloth->move_anchors(shifted(points_of(scene), 0.002 * frame)));
          step(*cloth, 0.01);
        }
      }
      CAPTURE(scene.constraints.size());
      CHECK(largest_distance(positions(lanes), positions(reference)) < 3e-6);
    }
  }
}

TEST_CASE("a copy goes on bit for bit, also while points travel") {
  for (const Backend backend : kBackends) {
    for (const SceneDescription& scene : anchored_scenes(9)) {
      Cloth cloth = cloth_of(scene, small_steps(backend));
      auto other = Cloth::create(cloth.model(), cloth.settings());
      REQUIRE(other);
      for (int k = 1; k <= 3; ++k) {
        run(cloth, 0.01, 2);
        REQUIRE(cloth.move_anchors(shifted(points_of(scene), 0.01 * k)));
        Cloth clone = cloth.clone();
        REQUIRE(other.value().copy_state(cloth));
        for (Cloth* each : {&cloth, &clone, &other.value()}) run(*each, 0.007, 2);
        CHECK(clone.state_hash() == cloth.state_hash());
        CHECK(other.value().state_hash() == cloth.state_hash());
      }
    }
  }
}

TEST_CASE("a step that is not committed leaves the points to the next one") {
  const SceneDescription scene = one_particle({}, {}, {.max_distance = 0.1});
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(scene, small_steps(backend)), undisturbed = cloth.clone();
    const Vec3 point{0.5, 0, 0}, pull{1e300, 0, 0};
    REQUIRE(cloth.move_anchors({&point, 1}));
    REQUIRE(undisturbed.move_anchors({&point, 1}));
    REQUIRE(cloth.write_forces({&pull, 1}));
    CHECK_FALSE(committed(step(cloth, 0.01).status));
    REQUIRE(cloth.write_forces({}));
    run(cloth, 0.01, 3);
    run(undisturbed, 0.01, 3);
    CHECK(cloth.state_hash() == undisturbed.state_hash());
  }
}

TEST_CASE("positions that are written beyond their limits are projected, and velocities stay") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = scene_of("hang", 9);
    scene.fixed.clear();
    scene.gravity = {0, 0, 0};
    anchor_all(scene, 0.05);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    std::vector<Vec3> away = scene.positions;
    for (Vec3& x : away) x = x + Vec3{0, 1, 0};
    REQUIRE(cloth.write_positions(away));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(largest_reach(scene, cloth, points_of(scene)) < 0.05 + 1e-4);
    for (const Vec3 v : velocities(cloth)) CHECK(length(v) < 1e-3);
  }
}

/// Its pins replaced by anchors that attach.
SceneDescription attached(SceneDescription scene) {
  for (const std::uint32_t i : scene.fixed)
    scene.anchors.push_back({.particle = i, .point = scene.positions[i]});
  scene.fixed.clear();
  return scene;
}

TEST_CASE("cloth that hangs on anchors alone takes the substeps that its load asks for") {
  for (const char* name : {"corners", "cape"}) {
    const SceneDescription scene = scene_of(name, 21);
    Cloth pinned = cloth_of(scene, {}), anchored = cloth_of(attached(scene), {});
    for (int frame = 0; frame < 40; ++frame) {
      const StepReport by_pins = step(pinned, 0.01), by_anchors = step(anchored, 0.01);
      CAPTURE(std::string(name));
      CAPTURE(frame);
      CHECK(by_anchors.status == Status::converged);
      CHECK(by_anchors.substeps >= by_pins.substeps);
      CHECK(by_anchors.visits <
            4 * by_anchors.substeps * static_cast<std::int64_t>(scene.constraints.size()));
    }
  }
}

TEST_CASE("a woven sheet swings on anchors as on pins, and keeps its energy without a guard") {
  for (const Backend backend : kBackends) {
    const SceneDescription scene = scene_of("corners", 13);
    Settings settings = small_steps(backend, 100);
    settings.iterations = 1;
    Cloth pinned = cloth_of(scene, settings), anchored = cloth_of(attached(scene), settings);
    const double start = pinned.energy().total();
    for (int frame = 0; frame < 30; ++frame) {
      step(pinned, 0.01);
      step(anchored, 0.01);
      CAPTURE(frame);
      CHECK(anchored.energy().total() == doctest::Approx(start).epsilon(2e-3));
    }
    CHECK(largest_distance(positions(pinned), positions(anchored)) < 0.005);
  }
}

TEST_CASE("a stretched string between two anchors ends within both tolerances") {
  for (const Backend backend : kBackends) {
    SceneDescription scene;
    for (std::uint32_t i = 0; i <= 20; ++i) {
      scene.positions.push_back({0.05 * i, 0, 0});
      scene.masses.push_back(0.01);
      if (i > 0) scene.constraints.push_back({i - 1, i, 0.05});
    }
    for (const std::uint32_t i : {0u, 20u})
      scene.anchors.push_back({.particle = i, .point = scene.positions[i], .max_distance = 0.001});
    Cloth cloth = cloth_of(scene, small_steps(backend));
    for (int frame = 0; frame < 60; ++frame) {
      const StepReport report = step(cloth, 0.01);
      CHECK(report.status == Status::converged);
      CHECK(report.max_strain <= 0.01 * (1 + 1e-6));
      CHECK(report.max_anchor_error <= 1e-4);
    }
  }
}

TEST_CASE("anchors that contradict constraints are reported, not resolved") {
  SceneDescription scene = scene_of("hang", 5);
  scene.fixed.clear();
  anchor_all(scene, 1e-9);
  for (Anchor& anchor : scene.anchors) anchor.point = 1.2 * anchor.point;
  Cloth cloth = cloth_of(scene, {});
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::infeasible);
  CHECK(report.max_strain == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(report.max_anchor_error < 1e-6);
}

TEST_CASE("anchors are for small steps, which automatic chooses; other solvers refuse them") {
  const auto model = model_of(one_particle({}, {}, {}));
  CHECK(describe(*model).anchors == 1);
  CHECK(Cloth::create(model, {}).value().settings().solver == Solver::small_steps);
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn}) {
    const auto cloth = Cloth::create(model, {.solver = solver});
    REQUIRE_FALSE(cloth);
    CHECK(cloth.error().find("anchors") != std::string::npos);
  }
}

TEST_CASE("limits of anchors that make no sense are refused, and change nothing") {
  SceneDescription scene = one_particle({0, 0, 0}, {}, {.max_distance = 0.1});
  Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
  const auto error = [](const Result<void>& result) {
    return result ? std::string() : result.error();
  };
  CHECK(error(cloth.limit_anchor(1, {})).find("anchor: no such anchor") == 0);
  CHECK(error(cloth.limit_anchor(0, {.max_distance = -1})).find("max_distance") !=
        std::string::npos);
  CHECK(error(cloth.limit_anchors({})).find("limits") == 0);
  CHECK(error(cloth.scale_anchors(-1)).find("scale") == 0);
  CHECK(error(cloth.scale_anchors(kInfinity)).find("scale") == 0);
  CHECK(error(cloth.move_fixed(0, {})).find("is not fixed") != std::string::npos);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_anchored_cloth
