/// Steps beside bodies of triangles allocate nothing once warm.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_mesh_allocation {
namespace {

/// A square of 1 m of cotton, held by two of its corners.
SceneDescription pinned_sheet() {
  constexpr std::uint32_t kSize = 12;
  MeshDescription mesh;
  for (std::uint32_t i = 0; i < kSize * kSize; ++i)
    mesh.positions.push_back({(i % kSize) / 11.0, 0, (i / kSize) / 11.0});
  for (std::uint32_t row = 0; row + 1 < kSize; ++row) {
    for (std::uint32_t p = kSize * row; p + 1 < kSize * (row + 1); ++p) {
      mesh.face_sizes.push_back(4);
      for (const std::uint32_t corner : {p, p + 1, p + kSize + 1, p + kSize})
        mesh.corners.push_back(corner);
    }
  }
  mesh.material = find_material("cotton").value();
  mesh.pins = {0, kSize - 1};
  return cloth_from_mesh(mesh).value().scene;
}

TEST_CASE("a warm step beside a mesh that moves and deforms allocates nothing") {
  const SceneDescription scene = pinned_sheet();
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  const TriangleMesh mesh = icosphere(0.3, 2);
  const Vec3 under{0.5, -0.45, 0.5};
  const std::vector<Vec3> at_rest(scene.positions.size());
  const auto id = add(cloth, {.shape = shape_of(mesh), .pose = {.position = under}});
  std::vector<std::vector<Vec3>> vertices;
  for (int i = 0; i < 20; ++i) {
    vertices.push_back(mesh.vertices);
    for (Vec3& v : vertices.back()) v.y *= 1 + 0.2 * std::sin(i * 0.314159265);
  }
  std::size_t in_steps = 0;
  const auto run_from_start = [&] {
    std::size_t failed = !cloth.write_positions(scene.positions);
    failed += !cloth.write_velocities(at_rest);
    failed += !cloth.place_body(id, {.position = under});
    failed += !cloth.place_body_vertices(id, mesh.vertices);
    for (std::size_t i = 0; i < 60; ++i) {
      failed += !cloth.move_body_vertices(id, vertices[i % 20]);
      failed +=
          !cloth.move_body(id, {.position = under + Vec3{0, 0.005 * static_cast<double>(i), 0}});
      const std::size_t before = allocations();
      failed += !cloth.step(1.0 / 60);
      if (i > 0) in_steps += allocations() - before;  // the first looks for who is inside
    }
    return failed;
  };
  REQUIRE(run_from_start() == 0);
  REQUIRE_FALSE(cloth.body_contacts().empty());
  const std::uint64_t end = cloth.state_hash();
  REQUIRE(run_from_start() == 0);
  REQUIRE(cloth.state_hash() == end);
  in_steps = 0;
  REQUIRE(run_from_start() == 0);
  CHECK(in_steps == 0);
}

}  // namespace
}  // namespace weft::test::engine_contact_mesh_allocation
