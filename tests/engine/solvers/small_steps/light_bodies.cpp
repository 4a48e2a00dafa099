/// Bodies that move by themselves and are lighter than the particles of the cloth that they fall
/// on.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <weft/mesh.h>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/free_body.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_light_bodies {
namespace {

constexpr double kG = 10;        // m/s^2
constexpr double kHeight = 0.5;  // m, that bodies fall from
constexpr std::uint32_t kSize = 9;

/// A level sheet, 0.4 m wide, 50 mm above a floor, or with pinned corners.
Cloth sheet_on(bool has_floor, bool is_of_quads) {
  MeshDescription mesh = is_of_quads ? quads(kSize) : right_triangles(kSize);
  for (Vec3& v : mesh.positions) v = {0.05 * v.x - 0.2, 0.05, 0.05 * v.y - 0.2};
  mesh.material = find_material("cotton").value();
  if (!has_floor) mesh.pins = {0, kSize - 1, kSize * (kSize - 1), kSize * kSize - 1};
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {0, -kG, 0};
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  if (has_floor) add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0}), .friction = 0.3});
  return cloth;
}

/// Particles of the sheet have 375 mg. Momentum that went from their past into that of a body which
/// is lighter threw it up by 80 m.
TEST_CASE("a body that is lighter than a particle is not thrown by the cloth that it falls on") {
  const ShapeDescription capsule = Capsule{{-0.05, 0, 0}, {0.05, 0, 0}, 0.03, 0.03};
  const ShapeDescription shapes[] = {Ball{{}, 0.05}, capsule, weft::box({0.12, 0.12, 0.12})};
  for (const bool has_floor : {true, false}) {
    for (const bool is_of_quads : {true, false}) {
      for (const ShapeDescription& shape : shapes) {
        for (const double mass : {1e-6, 1e-5, 1e-4}) {
          for (const int rate : {30, 60, 240}) {
            CAPTURE(has_floor);
            CAPTURE(is_of_quads);
            CAPTURE(shape.index());
            CAPTURE(mass);
            CAPTURE(rate);
            Cloth cloth = sheet_on(has_floor, is_of_quads);
            const Free body = add_free(cloth, shape, mass, {.position = {0.03, kHeight, 0.02}});
            for (int frame = 0; frame < rate; ++frame) {
              REQUIRE(committed(step(cloth, 1. / rate).status));
              const double fallen = std::max(0.0, kHeight - body.centre(cloth).y);
              REQUIRE(body.kinetic(cloth) < 1.3 * mass * kG * fallen + 1e-9 * mass);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_light_bodies
