#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <limits>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_welding {
namespace {

/// Two unit squares side by side that share no vertex; vertex 8 is in no face.
MeshDescription two_squares(double gap) {
  MeshDescription mesh;
  for (const double x : {0.0, 1 + gap}) {
    for (const Vec3 v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}) {
      mesh.positions.push_back({x + v.x, v.y, v.z});
    }
  }
  mesh.positions.push_back({9, 9, 9});
  mesh.corners = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh.face_sizes = {4, 4};
  return mesh;
}

TEST_CASE("vertices at equal positions are one particle, zeros of either sign too") {
  MeshDescription mesh = two_squares(0);
  mesh.positions[1].y = -0.0;
  mesh.pins = {4, 1};
  const MeshCloth cloth = made(mesh);
  CHECK(cloth.particle_of_vertex == std::vector<std::uint32_t>{0, 1, 2, 3, 1, 4, 5, 2, kNoIndex});
  CHECK(cloth.scene.positions.size() == 6);
  CHECK(cloth.scene.constraints.size() == 7);
  CHECK(cloth.scene.fixed == std::vector<std::uint32_t>{1});
  CHECK(cloth.counts.welded_vertices == 2);
  CHECK(cloth.counts.unused_vertices == 1);
  CHECK(cloth.counts.pieces == 1);
  CHECK(build_model(cloth.scene));
}

TEST_CASE("what differs in the last bit is two particles, unless a distance says otherwise") {
  MeshDescription mesh = two_squares(1e-6);
  CHECK(made(mesh).scene.positions.size() == 8);
  CHECK(made(mesh).counts.pieces == 2);
  mesh.weld_distance = 0.9e-6;
  CHECK(made(mesh).scene.positions.size() == 8);
  mesh.weld_distance = 1.1e-6;
  const MeshCloth cloth = made(mesh);
  CHECK(cloth.scene.positions.size() == 6);
  CHECK(cloth.scene.positions[1].x == doctest::Approx(1 + 0.5e-6).epsilon(1e-12));
}

TEST_CASE("a chain of near vertices is one particle, across cells of any place") {
  MeshDescription mesh;
  for (int i = 0; i < 40; ++i) mesh.positions.push_back({-0.1 + 0.009 * i, 0, 0});
  mesh.positions.push_back({5, 0, 0});
  for (std::uint32_t i = 0; i < 40; ++i) mesh.lines.push_back({i, 40});
  mesh.weld_distance = 0.01;
  CHECK(made(mesh).scene.positions.size() == 2);
  mesh.weld_distance = 0.0089;
  CHECK(made(mesh).scene.positions.size() == 41);
}

TEST_CASE("seams join vertices that lie apart, and faces keep their shapes") {
  MeshDescription mesh = two_squares(3);
  mesh.seams = {{1, 4}, {2, 7}, {0, 8}};
  mesh.material = plain_material();
  const MeshCloth cloth = made(mesh);
  CHECK(cloth.scene.positions.size() == 6);
  CHECK(cloth.scene.positions[1].x == doctest::Approx(2.5));
  CHECK(cloth.counts.pieces == 1);
  for (const Constraint& c : cloth.scene.constraints) {
    CHECK((c.rest_length == doctest::Approx(1) || c.rest_length == doctest::Approx(std::sqrt(2))));
  }
  CHECK(area_of(cloth.scene, *mesh.material) == doctest::Approx(2));
  for (const BendingElement& element : cloth.scene.bending) CHECK(element.rest == 0);
  CHECK(build_model(cloth.scene));
}

TEST_CASE("what is sewn bends as if it had been one piece") {
  MeshDescription one = quads(6);
  one.material = plain_material();
  MeshDescription panels = one;
  const auto moved = static_cast<std::uint32_t>(panels.positions.size());
  for (std::uint32_t v = 0; v < moved; ++v) {
    panels.positions.push_back(panels.positions[v]);
    panels.positions.back().x += 100;
    panels.seams.push_back({v, moved + v});
  }
  for (std::size_t i = 0; i < 4 * 5 * 3; ++i) panels.corners[i] += moved;
  MeshCloth sewn = made(panels);
  const MeshCloth whole = made(one);
  REQUIRE(sewn.scene.positions.size() == whole.scene.positions.size());
  std::vector<Vec3> bent(whole.scene.positions.size()), bent_sewn = bent;
  for (std::uint32_t v = 0; v < moved; ++v) {
    const Vec3 p = one.positions[v];
    const Vec3 place{p.x, p.y, 0.01 * p.x * p.x};
    bent[whole.particle_of_vertex[v]] = place;
    for (const std::uint32_t copy : {v, moved + v}) {
      if (sewn.particle_of_vertex[copy] != kNoIndex) {
        bent_sewn[sewn.particle_of_vertex[copy]] = place;
      }
    }
  }
  CHECK(bending_energy(sewn.scene, bent_sewn) ==
        doctest::Approx(bending_energy(whole.scene, bent)).epsilon(1e-9));
}

TEST_CASE("input that means nothing is refused by field, index and value") {
  const auto with = [](auto change) {
    MeshDescription mesh = two_squares(0);
    change(mesh);
    return refusal(mesh);
  };
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(with([&](auto& m) { m.positions[3].z = inf; }) ==
        "positions[3]: must be finite (0, 1, inf)");
  CHECK(with([](auto& m) { m.corners[5] = 9; }) ==
        "corners[5]: no such vertex, the mesh has 9 (9)");
  CHECK(with([](auto& m) { m.face_sizes = {}; }) == "corners: triangles need a multiple of 3 (8)");
  CHECK(with([](auto& m) {
          m.face_sizes = {6, 2};
        }) == "face_sizes[1]: a face has three corners at least (2)");
  CHECK(with([](auto& m) {
          m.face_sizes = {4, 3};
        }) == "face_sizes: must sum to the number of corners, 8 (7)");
  CHECK(with([](auto& m) {
          m.lines = {{0, 1}, {0, 77}};
        }) == "lines[1][1]: no such vertex, the mesh has 9 (77)");
  CHECK(with([](auto& m) {
          m.seams = {{12, 1}};
        }) == "seams[0][0]: no such vertex, the mesh has 9 (12)");
  CHECK(with([](auto& m) {
          m.pins = {0, 8};
        }) == "pins[1]: this vertex is in no face and no line (8)");
  CHECK(with([](auto& m) { m.pins = {9}; }) == "pins[0]: no such vertex, the mesh has 9 (9)");
  CHECK(with([](auto& m) { m.mass = 0; }) == "mass: must be finite and greater than 0 (0)");
  CHECK(with([](auto& m) { m.weld_distance = -1; }) ==
        "weld_distance: must be finite and at least 0 (-1)");
  CHECK(with([](auto& m) { m.corners = m.face_sizes = {}; }) ==
        "corners: the mesh has no face and no line");
  CHECK(with([](auto& m) { m.weld_distance = 10; }) == "every edge of the mesh has length 0");
}

}  // namespace
}  // namespace weft::test::engine_mesh_welding
