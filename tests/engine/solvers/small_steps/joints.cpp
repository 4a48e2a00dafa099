/// Seams that share a particle with others, or with a slider.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <weft/mesh.h>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_joints {
namespace {

constexpr int kRates[] = {30, 60, 240};
constexpr std::uint32_t kSize = 8;  // vertices along an edge
constexpr double kSpacing = 0.05;   // m
constexpr double kApart = 0.02;     // m, from one layer to the next
constexpr double kTime = 0.5;       // s, of seams

/// Level layers below each other, whose first rows are sewn: each to that of the next.
MeshDescription layers(std::uint32_t count, bool is_of_quads, const char* material) {
  const MeshDescription layer = is_of_quads ? quads(kSize) : equilateral_triangles(kSize);
  constexpr std::uint32_t kVertices = kSize * kSize;
  MeshDescription mesh;
  for (std::uint32_t k = 0; k < count; ++k) {
    for (std::uint32_t i = 0; i < kVertices; ++i)
      mesh.positions.push_back({kSpacing * (i % kSize), -kApart * k, kSpacing * (i / kSize)});
    for (const std::uint32_t corner : layer.corners) mesh.corners.push_back(corner + k * kVertices);
    mesh.face_sizes.insert(mesh.face_sizes.end(), layer.face_sizes.begin(), layer.face_sizes.end());
    for (std::uint32_t i = 0; i < kSize && k > 0; ++i)
      mesh.seams.push_back({i + (k - 1) * kVertices, i + k * kVertices});
  }
  mesh.seam_time = kTime;
  mesh.material = find_material(material).value();
  return mesh;
}

double widest(const Cloth& cloth, const SceneDescription& scene) {
  double most = 0;
  for (const Seam& seam : scene.seams)
    most = std::max(most, distance(cloth.position(seam.a), cloth.position(seam.b)));
  return most;
}

/// All steps converge, the gap is half as wide after half of the time, and closed after it.
void check_that_seams_close(const SceneDescription& scene, int rate) {
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  const double before = widest(cloth, scene);
  const int half = static_cast<int>(std::lround(kTime / 2 * rate));
  for (int frame = 1; frame <= 6 * half; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, 1. / rate);
    REQUIRE(report.status == Status::converged);
    if (frame == half)
      CHECK(widest(cloth, scene) ==
            doctest::Approx((1 - half / (kTime * rate)) * before).epsilon(0.05));
    if (frame > 2 * half) REQUIRE(report.open_seams == 0);
  }
  CHECK(widest(cloth, scene) < 2e-4);
}

TEST_CASE(
    "layers that are sewn one to the next come together in their time, and hang from the first") {
  for (const std::uint32_t count : {3u, 4u}) {
    for (const bool is_of_quads : {true, false}) {
      for (const char* material : {"cotton", "denim"}) {
        MeshDescription mesh = layers(count, is_of_quads, material);
        for (std::uint32_t i = 0; i < kSize; ++i) mesh.pins.push_back(i);
        const SceneDescription scene = made(mesh).scene;
        for (const int rate : kRates) {
          CAPTURE(count);
          CAPTURE(is_of_quads);
          CAPTURE(std::string(material));
          CAPTURE(rate);
          check_that_seams_close(scene, rate);
        }
      }
    }
  }
}

/// every: as many particles of the first row slide on a rail.
SceneDescription on_a_rail(const MeshDescription& mesh, std::uint32_t every) {
  SceneDescription scene = made(mesh).scene;
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (std::uint32_t i = 0; i < 3; ++i) {
    scene.positions.push_back({-0.2 + 0.4 * i, 0, 0});
    scene.masses.push_back(1);
    scene.fixed.push_back(first + i);
    scene.rail_particles.push_back(first + i);
  }
  for (std::uint32_t i = 0; i < kSize; i += every)
    scene.sliders.push_back({.particle = i, .first = 0, .last = 2, .friction = 0.2});
  return scene;
}

TEST_CASE(
    "a layer that is sewn to one on a rail comes to it in its time, and hangs from the rail") {
  for (const bool is_of_quads : {true, false}) {
    for (const std::uint32_t every : {1u, 2u}) {
      const SceneDescription scene = on_a_rail(layers(2, is_of_quads, "cotton"), every);
      for (const int rate : kRates) {
        CAPTURE(is_of_quads);
        CAPTURE(every);
        CAPTURE(rate);
        check_that_seams_close(scene, rate);
      }
    }
  }
}

TEST_CASE("four corners that are sewn in a ring meet where their masses say") {
  for (const Backend backend : kBackends) {
    SceneDescription scene;
    scene.positions = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0.1}, {0, 0, 0.1}};
    scene.masses = {1, 2, 3, 4};
    scene.gravity = {0, 0, 0};
    for (std::uint32_t i = 0; i < 4; ++i) scene.seams.push_back({i, (i + 1) % 4, kTime});
    Cloth cloth =
        cloth_of(scene, {.solver = Solver::small_steps, .backend = backend, .threads = 1});
    for (int frame = 1; frame <= 40; ++frame) {
      const StepReport report = step(cloth, 1. / 60);
      REQUIRE(report.status == Status::converged);
      if (frame > 31) CHECK(report.open_seams == 0);
    }
    for (std::uint32_t i = 0; i < 4; ++i)
      CHECK(distance(cloth.position(i), {0.05, 0, 0.07}) < 1e-3);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_joints
