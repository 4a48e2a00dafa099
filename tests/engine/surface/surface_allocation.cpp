/// What is read each frame allocates nothing.
#include <doctest/doctest.h>
#include <weft/surface.h>

#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_surface_surface_allocation {
namespace {

MeshDescription sheet_of(std::uint32_t cells) {
  MeshDescription mesh;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j)
      mesh.positions.push_back({1. * i / cells, 1. * j / cells, 0});
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t j = 0; j < cells; ++j) {
      const std::uint32_t a = i * (cells + 1) + j, b = a + cells + 1;
      mesh.corners.insert(mesh.corners.end(), {a, b, b + 1, a + 1});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.pins = {0, 1, 2, 3, 4};
  return mesh;
}

TEST_CASE(
    "reading buffers, vertices and levels of detail, and moving many pins, allocate nothing") {
  const MeshDescription mesh = sheet_of(8), fine = sheet_of(20);
  const MeshCloth made = cloth_from_mesh(mesh).value();
  Cloth cloth = cloth_of(made.scene, {});
  Cloth near = cloth_of(cloth_from_mesh(fine).value().scene, {});
  Surface direct = surface_of_mesh(mesh, made).value();
  Surface mapped = map_surface(mesh, made, fine).value();
  std::vector<float> coarse_buffer(81 * 6), fine_buffer(441 * 6);
  const auto normals_of = [](std::vector<float>& buffer) {
    return FloatVectors{std::span(buffer).subspan(3), 6};
  };
  const auto frame = [&] {
    int failed = 0;
    failed += !cloth.move_fixed(mesh.pins, std::span(mesh.positions).first(5));
    failed += !cloth.read_positions({coarse_buffer, 6}, {1, 2, 3});
    failed += !cloth.read_velocities({coarse_buffer, 6});
    failed += !(cloth.bounds().most.x > 0);
    failed += !direct.read_vertices(cloth, {coarse_buffer, 6}, normals_of(coarse_buffer));
    failed += !mapped.read_vertices(cloth, {fine_buffer, 6}, normals_of(fine_buffer));
    failed += !mapped.copy_shape(cloth, near);
    return failed;
  };
  REQUIRE(frame() == 0);
  const std::size_t before = allocations();
  const int failed = frame();
  CHECK(allocations() == before);
  CHECK(failed == 0);
}

}  // namespace
}  // namespace weft::test::engine_surface_surface_allocation
