#include "tools/program/measure/fabric_measure.h"

#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>

#include "tools/scenes/mesh.h"

namespace weft::tools {
namespace {

/// 4 x 4 cells of 0.1 m by 0.2 m, the warp along y; cut into triangles that are no cells, or not.
MeshCloth cloth_of(bool is_cut) {
  std::vector<Vec3> places;
  std::vector<std::vector<std::uint32_t>> faces;
  for (std::uint32_t i = 0; i < 5; ++i) {
    for (std::uint32_t j = 0; j < 5; ++j) {
      const double skew = is_cut ? 0.4 : 0;
      places.push_back({0.1 * i, 0.2 * j + skew * 0.1 * i, 0});
      if (i == 4 || j == 4) continue;
      const std::uint32_t a = 5 * i + j, b = a + 5, c = b + 1, d = a + 1;
      if (!is_cut) faces.push_back({a, b, c, d});
      if (is_cut) faces.insert(faces.end(), {{a, b, d}, {b, c, d}});
    }
  }
  MeshDescription mesh = describe_mesh(places, faces);
  mesh.material = find_material("cotton").value();
  mesh.warp = {{0, 1, 0}};
  return cloth_from_mesh(mesh).value();
}

/// Longer by these shares along y and along x, then sheared by the angle.
FabricStrain measured(bool is_cut, FabricStrain strain, bool is_fixed = false) {
  MeshCloth made = cloth_of(is_cut);
  CHECK(made.cells.empty() == is_cut);
  if (is_fixed) {
    for (std::uint32_t i = 0; i < made.scene.positions.size(); ++i) made.scene.fixed.push_back(i);
  }
  const FabricMeasure measure(made.scene, made.cells);
  CHECK(measure.is_empty() == is_fixed);
  std::vector<Vec3> positions = made.scene.positions;
  for (Vec3& p : positions) {
    const double along_warp = (1 + strain.warp) * p.y, along_weft = (1 + strain.weft) * p.x;
    p = {along_weft + std::sin(strain.shear) * along_warp, std::cos(strain.shear) * along_warp, 3};
  }
  made.scene.positions = positions;
  const auto model = build_model(made.scene);
  REQUIRE_MESSAGE(model, model.error());
  return measure(Cloth::create(model.value(), {}).value());
}

TEST_CASE(
    "warp, weft and shear of an affine deformation are read as they are, cells or triangles") {
  for (const bool is_cut : {false, true}) {
    for (const FabricStrain& strain :
         {FabricStrain{0.25, 0.125, 0}, {0, 0, 0.34}, {0.1, 0, -0.5}, {-0.05, 0.5, 1}}) {
      CAPTURE(is_cut);
      CAPTURE(strain.shear);
      const FabricStrain read = measured(is_cut, strain);
      CHECK(read.warp == doctest::Approx(std::abs(strain.warp)).epsilon(1e-6));
      CHECK(read.weft == doctest::Approx(std::abs(strain.weft)).epsilon(1e-6));
      CHECK(read.shear == doctest::Approx(std::abs(strain.shear)).epsilon(1e-6));
    }
  }
}

TEST_CASE("what lies between fixed particles counts for nothing") {
  for (const bool is_cut : {false, true}) CHECK(measured(is_cut, {0.5, 0, 0}, true).warp == 0);
}

}  // namespace
}  // namespace weft::tools
