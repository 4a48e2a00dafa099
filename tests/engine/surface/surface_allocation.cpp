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

TEST_CASE("reading cloth that has torn allocates nothing") {
  MeshDescription mesh = sheet_of(6);
  mesh.pins = {0, 1, 2, 3, 4, 5, 6, 42, 43, 44, 45, 46, 47, 48};
  mesh.material = {.density = 0.5, .warp = 200, .weft = 200, .shear = 20};
  mesh.material->strength = 4;
  const MeshCloth made = cloth_from_mesh(mesh).value();
  Cloth cloth = cloth_of(made.scene, {});
  Surface direct = surface_of_mesh(mesh, made).value();
  Surface mapped = map_surface(mesh, made, sheet_of(10)).value();
  for (double x = 1; cloth.particle_count() == made.scene.positions.size(); x += 1e-3) {
    for (std::size_t i = 7; i < 14; ++i)
      REQUIRE(cloth.move_fixed(mesh.pins[i], {x, mesh.positions[mesh.pins[i]].y, 0}));
    REQUIRE(cloth.step(1.0 / 60));
    REQUIRE(x < 2);
  }
  REQUIRE(direct.follow(cloth).value());
  REQUIRE(mapped.follow(cloth).value());
  std::vector<float> coarse(6 * direct.vertex_count()), fine(6 * mapped.vertex_count());
  const auto read = [&](Surface& surface, std::vector<float>& floats) {
    const FloatVectors normals{std::span(floats).subspan(3), 6};
    return surface.follow(cloth) && surface.read_vertices(cloth, {floats, 6}, normals);
  };
  const auto frame = [&] { return read(direct, coarse) && read(mapped, fine); };
  REQUIRE(frame());
  const std::size_t before = allocations();
  const bool is_read = frame();
  CHECK(allocations() == before);
  CHECK(is_read);
}

}  // namespace
}  // namespace weft::test::engine_surface_surface_allocation
