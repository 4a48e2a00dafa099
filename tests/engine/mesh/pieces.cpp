#include "engine/mesh/pieces.h"

#include <doctest/doctest.h>
#include <weft/mesh.h>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_pieces {
namespace {

using mesh::Pieces;
using mesh::pieces_of;

TEST_CASE("what constraints and triangles join is a piece; fixed particles and anchors hold it") {
  SceneDescription scene;
  scene.positions.resize(10);
  scene.constraints = {{0, 1, 1}, {3, 4, 1}, {1, 2, 1}};
  scene.membrane = {{{5, 6, 7}}};
  scene.spheres = {4, 8};
  scene.fixed = {2};
  scene.anchors = {{.particle = 6}};
  const Pieces pieces = pieces_of(scene);
  CHECK(pieces.of_particle == std::vector<std::uint32_t>{0, 0, 0, 1, 1, 2, 2, 2, kNoIndex, 3});
  CHECK(pieces.held == std::vector<bool>{true, false, true, false});
  CHECK(pieces.count == 4);
  CHECK(pieces.loose() == 2);
  scene.tethers = {{.particle = 9, .pin = 2, .length = 1}};
  CHECK(pieces_of(scene).loose() == 1);
}

/// Two strips of three edges, one above the other.
SceneDescription strips(double gap) {
  SceneDescription scene;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 4; ++i) scene.positions.push_back({0.1 * i, -gap * row, 0});
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 4u, 5u, 6u})
    scene.constraints.push_back({i, i + 1, 0.1});
  scene.fixed = {0};
  return scene;
}

TEST_CASE("the distance that would join loose pieces is a power of ten, and far below an edge") {
  const auto joining = [](const SceneDescription& scene) {
    return joining_distance(scene, pieces_of(scene));
  };
  CHECK(joining(strips(3e-6)) == doctest::Approx(1e-5));
  CHECK(joining(strips(2e-4)) == doctest::Approx(1e-3));
  CHECK(joining(strips(0.02)) == 0);
  CHECK(joining(strips(0)) == 0);
}

TEST_CASE("a mesh counts its pieces, those without a pin, and what would weld them") {
  MeshDescription sheet = test::right_triangles(4), soup;
  for (std::size_t corner = 0; corner < sheet.corners.size(); ++corner) {
    const Vec3 p = sheet.positions[sheet.corners[corner]];
    const double apart = 1.7e-6 * static_cast<double>(corner);
    soup.positions.push_back({p.x + apart, p.y, p.z});
    soup.corners.push_back(static_cast<std::uint32_t>(corner));
  }
  for (const bool has_material : {true, false}) {
    if (has_material) soup.material = test::plain_material();
    if (!has_material) soup.material.reset();
    soup.pins = {0, 1};
    soup.weld_distance = 0;
    const MeshCounts apart = test::made(soup).counts;
    CHECK(apart.pieces == 18);
    CHECK(apart.loose_pieces == apart.pieces - 1);
    CHECK(apart.suggested_weld == doctest::Approx(1e-4));
    soup.weld_distance = apart.suggested_weld;
    const MeshCounts welded = test::made(soup).counts;
    CHECK(welded.pieces == 1);
    CHECK(welded.loose_pieces == 0);
    CHECK(welded.suggested_weld == 0);
    soup.pins.clear();
    CHECK(test::made(soup).counts.loose_pieces == 1);
  }
}

}  // namespace
}  // namespace weft::test::engine_mesh_pieces
