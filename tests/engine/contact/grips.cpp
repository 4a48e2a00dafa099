/// Two pads grip a fold of cloth and lift it.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_grips {
namespace {

constexpr double kEdge = 0.02;         // m
constexpr std::uint32_t kMiddle = 10;  // of 21 rows
constexpr double kLayer = 6e-4;        // m, of half a fold from its middle

/// A level sheet whose middle rows stand upright, in two layers.
SceneDescription folded_sheet(double friction) {
  MeshDescription mesh = quads(2 * kMiddle + 1);
  mesh.rest_positions = mesh.positions;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double row = mesh.positions[i].x - kMiddle, beside = mesh.positions[i].y - kMiddle;
    const double up = std::max(0.0, 3 - std::abs(row)), out = std::max(0.0, std::abs(row) - 3);
    const double side = row > 0 ? 1 : row < 0 ? -1 : 0;
    mesh.positions[i] = {side * (kLayer + out * kEdge), 2 * kLayer + up * kEdge, beside * kEdge};
    mesh.rest_positions[i] = {row * kEdge, 0, beside * kEdge};
  }
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.friction = friction;
  return scene;
}

struct Grip {
  double gap = 0, friction = 0, rate = 0;  // m, 1, Hz
};

void check_grip(const Grip& by) {
  CAPTURE(by.gap);
  CAPTURE(by.friction);
  CAPTURE(by.rate);
  Cloth cloth = cloth_of(folded_sheet(by.friction), {.solver = Solver::small_steps, .threads = 1});
  add(cloth, {.shape = shape_of(Plane{}), .friction = 0.3});
  const Vec3 size{0.02, 0.06, 0.06};
  constexpr double kOpen = 0.012, kLift = 0.3;  // m
  const auto pose = [&](double side, double gap, double height) {
    return Pose{.position = {side * (gap + size.x) / 2, 0.034 + height, 0}};
  };
  std::array<std::uint32_t, 2> pads{};
  for (std::size_t i = 0; i < 2; ++i) {
    pads[i] = add(cloth, {.shape = shape_of(box(size)),
                          .pose = pose(i == 0 ? -1 : 1, kOpen, 0),
                          .friction = by.friction});
  }
  const auto frames = std::lround(1.5 * by.rate);
  int missed = 0;
  for (long k = 1; k <= frames; ++k) {
    const double time = static_cast<double>(k) / by.rate;
    const double gap = std::max(by.gap, kOpen - (kOpen - by.gap) * time / 0.3);
    const double height = kLift * std::clamp(time - 0.4, 0.0, 1.0);
    for (std::size_t i = 0; i < 2; ++i)
      REQUIRE(cloth.move_body(pads[i], pose(i == 0 ? -1 : 1, gap, height)));
    missed += step(cloth, 1 / by.rate).status == Status::converged ? 0 : 1;
  }
  CHECK(missed == 0);
  double top = 0;
  for (const Vec3 x : positions(cloth)) top = std::max(top, x.y);
  CHECK(top > kLift + 0.034);
}

TEST_CASE("two pads that are nearer than both thicknesses hold a fold, and no frame misses") {
  for (const double gap : {1.8e-3, 1e-3, 5e-4}) {
    for (const double rate : {30.0, 60.0}) check_grip({gap, 0.5, rate});
    check_grip({gap, 3, 60});
  }
  check_grip({1e-3, 0.5, 240});
}

}  // namespace
}  // namespace weft::test::engine_contact_grips
