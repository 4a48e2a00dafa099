/// Layers that begin exactly in one plane take an order, and go nowhere through each other.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/layers.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_coplanar_layers {
namespace {

/// Two squares at one height, of which the second is askew, and faces up or down. The corners of
/// the first are counterclockwise from below if it faces down.
struct Way {
  bool first_is_up = true, second_is_up = true;
};

SceneDescription in_one_plane(std::uint32_t cells, const char* material, const Way& way) {
  const auto place = [](double x, double z) { return Vec3{x, 0.02, z}; };
  SceneDescription scene =
      scene_of({{cells, cells,
                 [&](double u, double v) {
                   const double x = 0.3 * (u - 0.5);
                   return place(way.first_is_up ? x : -x, 0.3 * (v - 0.5));
                 }},
                {cells + 1, cells,
                 [&](double u, double v) {
                   const double x = way.second_is_up ? 0.3 * (u - 0.5) : -0.3 * (u - 0.5),
                                z = 0.3 * (v - 0.5);
                   return place(0.1 + std::cos(0.4) * x - std::sin(0.4) * z,
                                std::sin(0.4) * x + std::cos(0.4) * z);
                 }}},
               0.3);
  const double share =
      find_material(material).value().density / find_material("cotton").value().density;
  for (double& mass : scene.masses) mass *= share;
  return scene;
}

/// Of a triangle, of any length.
Vec3 front_of(const SceneDescription& scene, std::size_t triangle) {
  const auto [a, b, c] = scene.surface[triangle];
  const auto& x = scene.positions;
  return cross(x[b] - x[a], x[c] - x[a]);
}

/// m, by which the second sheet is above the first where both are, in the mean of particles of the
/// second that are over the middle of the first.
double height_of_second(const Cloth& cloth, std::uint32_t first_count) {
  double lower = 0, upper = 0;
  int lowers = 0, uppers = 0;
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
    const Vec3 x = cloth.position(i);
    if (std::abs(x.x - 0.05) > 0.06 || std::abs(x.z) > 0.06) continue;
    (i < first_count ? lower : upper) += x.y;
    ++(i < first_count ? lowers : uppers);
  }
  return upper / uppers - lower / lowers;
}

TEST_CASE("two sheets in one plane come apart: the later one goes to its front" *
          doctest::test_suite("long")) {
  for (const auto& [material, cells] : {std::pair{"cotton", 6u}, std::pair{"denim", 9u}}) {
    for (const Way way : {Way{true, true}, Way{true, false}, Way{false, true}, Way{false, false}}) {
      for (const int rate : {30, 60, 240}) {
        CAPTURE(std::string(material));
        CAPTURE(way.first_is_up);
        CAPTURE(way.second_is_up);
        CAPTURE(rate);
        SceneDescription scene = in_one_plane(cells, material, way);
        const std::uint32_t first_count = (cells + 1) * (cells + 1);
        for (std::uint32_t i = 0; i < scene.positions.size(); ++i)
          scene.velocities.push_back({i < first_count ? 0.3 : -0.3, 0, 0});
        Cloth cloth = cloth_of(scene, {.threads = 1});
        add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
        for (int frame = 0; frame < rate / 3; ++frame) {
          CAPTURE(frame);
          const StepReport report = step(cloth, 1.0 / rate);
          CHECK(report.status == Status::converged);
          CHECK(report.tangled == 0);
          CHECK(count_self_crossings({positions(cloth), scene.surface}) == 0);
        }
        const bool faces_up = front_of(scene, scene.surface.size() - 1).y > 0;
        const double height = height_of_second(cloth, first_count);
        CHECK((faces_up ? height : -height) > 0.5 * kLayerThickness);
      }
    }
  }
}

TEST_CASE("a sheet that was folded flat opens with its backs within") {
  for (const bool turns_over : {false, true}) {
    for (const int rate : {30, 60, 240}) {
      CAPTURE(turns_over);
      CAPTURE(rate);
      // Over a crease in the middle; cells along both directions are numbered across it.
      SceneDescription scene =
          scene_of({{8, 5,
                     [=](double u, double v) {
                       const double x = 0.3 * (u < 0.5 ? u : 1 - u) + (u > 0.5 ? 0.002 : 0);
                       return Vec3{turns_over ? -x : x, 0.02, 0.2 * v + (u > 0.5 ? 0.003 : 0)};
                     }}},
                   0.3);
      Cloth cloth = cloth_of(scene, {.threads = 1});
      add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
      for (int frame = 0; frame < rate / 3; ++frame) {
        CAPTURE(frame);
        const StepReport report = step(cloth, 1.0 / rate);
        CHECK(report.tangled == 0);
        CHECK(count_self_crossings({positions(cloth), scene.surface}) == 0);
      }
      const double height = cloth.position(8 * 6 + 2).y - cloth.position(2).y;
      CHECK((front_of(scene, 0).y > 0 ? height : -height) < 0);
    }
  }
}

TEST_CASE("two sheets that hang in one plane by pins in one line stop nothing, and stay apart") {
  const std::uint32_t kCells = 8, kCount = (kCells + 1) * (kCells + 1);
  std::vector<std::uint32_t> pins;
  for (std::uint32_t j = 0; j <= kCells; ++j) {
    pins.push_back(j);
    pins.push_back(kCount + j);
  }
  const auto hanging = [](double aside) {
    return [aside](double u, double v) { return Vec3{0.3 * v + aside, -0.3 * u, 0}; };
  };
  const SceneDescription scene =
      scene_of({{kCells, kCells, hanging(0)}, {kCells, kCells, hanging(0.017)}}, 0.3, pins);
  std::vector<std::array<std::uint32_t, 3>> free;  // what pins do not hold in one line
  std::ranges::copy_if(scene.surface, std::back_inserter(free), [&](const auto& corners) {
    return std::ranges::none_of(corners,
                                [&](std::uint32_t corner) { return corner % kCount <= kCells; });
  });
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, {.threads = 1});
    for (int frame = 0; frame < rate / 2; ++frame) {
      const StepReport report = step(cloth, 1.0 / rate);
      CHECK(report.status == Status::converged);
      CHECK(report.contact_failures == 0);
      CHECK(report.tangled == 0);
      CHECK(count_self_crossings({positions(cloth), free}) == 0);
    }
    CHECK(std::abs(cloth.position(kCount + 40).z - cloth.position(40).z) > 0.5 * kLayerThickness);
  }
}

TEST_CASE("random sheets in few planes, which move against each other, cross nothing" *
          doctest::test_suite("long")) {
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    CAPTURE(k);
    std::vector<Sheet> sheets;
    const std::uint32_t count = 2 + random.below(4);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double turn = random.between(0, 6), x = random.between(-0.1, 0.1),
                   z = random.between(-0.1, 0.1), y = 0.02 * (1 + random.below(2)),
                   mirror = random.below(2) == 0 ? -1 : 1;
      const std::uint32_t cells = 2 + random.below(5);
      sheets.push_back({cells, cells, [=](double u, double v) {
                          const double a = 0.2 * mirror * (u - 0.5), b = 0.2 * (v - 0.5);
                          return Vec3{x + std::cos(turn) * a - std::sin(turn) * b, y,
                                      z + std::sin(turn) * a + std::cos(turn) * b};
                        }});
    }
    SceneDescription scene = scene_of(sheets, random.between(0, 1));
    for (const Sheet& sheet : sheets) {
      const Vec3 v = random.in_box(1);
      for (std::uint32_t i = 0; i < (sheet.rows + 1) * (sheet.columns + 1); ++i)
        scene.velocities.push_back(v);
    }
    Cloth cloth = cloth_of(scene, {.threads = 1});
    add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
    for (int frame = 0; frame < 15; ++frame) {
      CAPTURE(frame);
      CHECK(step(cloth, 1.0 / 60).tangled == 0);
      CHECK(count_self_crossings({positions(cloth), scene.surface}) == 0);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_coplanar_layers
