/// Stretch around particles, against strains that are known.
#include "tools/program/measure/stretch.h"

#include <doctest/doctest.h>

namespace weft::tools {
namespace {

TEST_CASE("a particle has the strain of the largest size, with its sign") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  scene.constraints = {{0, 1, 0.8}, {1, 2, 1.25}, {2, 3, 2, ConstraintKind::rope}};
  const StretchMeasure measure(scene, {});
  const std::vector<double> stretch = measure(scene.positions);
  CHECK(stretch[0] == doctest::Approx(0.25));
  CHECK(stretch[1] == doctest::Approx(0.25));
  CHECK(stretch[2] == doctest::Approx(-0.2));
  CHECK(stretch[3] == 0);  // a slack rope
}

TEST_CASE("diagonals of cells and what pins hold are left out") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  scene.constraints = {{0, 1, 0.5}, {0, 2, 1}, {1, 2, 0.9}};
  scene.fixed = {0, 1};
  const std::vector<std::array<std::uint32_t, 4>> cells{{0, 1, 2, 3}};
  CHECK(find_diagonals(scene.constraints, cells) == std::vector<bool>{false, true, false});
  const std::vector<double> stretch = StretchMeasure(scene, cells)(scene.positions);
  CHECK(stretch[0] == 0);
  CHECK(stretch[1] == doctest::Approx(1 / 0.9 - 1));
  CHECK(stretch[2] == doctest::Approx(1 / 0.9 - 1));
}

TEST_CASE("triangles of fabric stretch along warp and weft, by the laws that they have") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1.1, 0, 0}, {0, 0.7, 0}};
  scene.membrane = {{{0, 1, 2}, {{{0, 0}, {1, 0}, {0, 1}}}, 100, 100, 10}};
  const auto stretch = [&] { return StretchMeasure(scene, {})(scene.positions)[2]; };
  CHECK(stretch() == doctest::Approx(-0.3));
  scene.membrane[0].kind = ConstraintKind::rope;
  CHECK(stretch() == doctest::Approx(0.1));
  scene.membrane[0].warp = 0;
  CHECK(stretch() == 0);
}

}  // namespace
}  // namespace weft::tools
