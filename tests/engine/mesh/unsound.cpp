/// Meshes as files have them: with faces without area, edges of three faces, T-junctions, twists.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_unsound {
namespace {

MeshDescription mesh_of(std::vector<Vec3> positions,
                        std::vector<std::vector<std::uint32_t>> faces) {
  MeshDescription mesh;
  mesh.positions = std::move(positions);
  for (const auto& face : faces) {
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
    mesh.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
  }
  mesh.material = plain_material();
  return mesh;
}

/// Numbers that a model takes, and a mass that is the area's.
MeshCloth sound(const MeshDescription& mesh) {
  MeshCloth cloth = made(mesh);
  const auto model = build_model(cloth.scene);
  CHECK_MESSAGE(model, model.error());
  return cloth;
}

const std::vector<Vec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST_CASE("faces without area are left out") {
  MeshDescription mesh = mesh_of(kSquare, {{0, 1, 2, 3}, {0, 1, 1}, {0, 2, 0}, {1, 1, 1, 1}});
  CHECK(sound(mesh).counts.degenerate_faces == 3);
  mesh.positions.push_back({0.5, 0.5, 0});
  mesh.corners.insert(mesh.corners.end(), {0, 4, 2});
  mesh.face_sizes.push_back(3);
  CHECK(refusal(mesh) ==
        "positions[4]: a material gives no mass to what is in no face with an area and no line "
        "with a "
        "length (0.5, 0.5, 0)");
  mesh.material.reset();
  CHECK(sound(mesh).counts.degenerate_faces == 4);
}

TEST_CASE("a T-junction that is closed by a face without area holds together") {
  const MeshDescription mesh =
      mesh_of({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, -2, 0}, {2, -2, 0}},
              {{0, 1, 3}, {0, 2, 1}, {0, 4, 2}, {4, 5, 2}, {5, 1, 2}});
  const MeshCloth cloth = sound(mesh);
  CHECK(cloth.counts.degenerate_faces == 1);
  CHECK(cloth.counts.pieces == 1);
  CHECK(area_of(cloth.scene, *mesh.material) == doctest::Approx(6));
}

TEST_CASE("slivers are as soft as they are narrow, and do not stiffen what is beside them") {
  const auto with_sliver = [](double height) {
    const MeshDescription mesh =
        mesh_of({{0, 0, 0}, {2, 0, 0}, {1, -height, 0}, {1, 2, 0}, {0, -2, 0}, {2, -2, 0}},
                {{0, 1, 3}, {0, 2, 1}, {0, 4, 2}, {4, 5, 2}, {5, 1, 2}});
    SceneDescription scene = sound(mesh).scene;
    for (Vec3& p : scene.positions) p.z = 0.01 * p.y * p.y;
    return bending_energy(scene, scene.positions);
  };
  CHECK(with_sliver(1e-4) == doctest::Approx(with_sliver(0.1)).epsilon(0.5));
}

TEST_CASE("an edge of three faces stretches, and does not bend") {
  const MeshDescription mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                                       {{0, 1, 2}, {0, 3, 1}, {0, 1, 4}});
  const MeshCloth cloth = sound(mesh);
  CHECK(cloth.counts.non_manifold_edges == 1);
  CHECK(cloth.scene.bending.empty());
  CHECK(cloth.scene.membrane.size() == 3);
}

TEST_CASE("concave and crossed quads are cut, polygons too") {
  const auto dart = mesh_of({{0, 0, 0}, {2, 1, 0}, {0.5, 1, 0}, {0, 2, 0}}, {{0, 1, 2, 3}});
  CHECK(sound(dart).counts.triangles == 2);
  CHECK(area_of(made(dart).scene, *dart.material) == doctest::Approx(1.25));
  CHECK(sound(mesh_of(kSquare, {{0, 1, 3, 2}})).counts.triangles == 2);
  const auto on_a_line = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}}, {{0, 1, 2, 3}});
  CHECK(sound(on_a_line).counts.triangles == 2);
  CHECK(area_of(made(on_a_line).scene, *on_a_line.material) == doctest::Approx(2));
  std::vector<Vec3> ring;
  for (int i = 0; i < 7; ++i) ring.push_back({std::cos(0.9 * i), std::sin(0.9 * i), 0});
  CHECK(sound(mesh_of(ring, {{0, 1, 2, 3, 4, 5, 6}})).counts.triangles == 5);
}

TEST_CASE("the same face twice is used once, whichever way round and wherever it begins") {
  auto mesh = mesh_of(kSquare, {{0, 1, 2, 3}, {2, 1, 0, 3}, {1, 2, 3, 0}});
  CHECK(sound(mesh).counts.double_faces == 2);
  CHECK(area_of(sound(mesh).scene, *mesh.material) == doctest::Approx(1));
  mesh = mesh_of(kSquare, {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}});
  for (const Vec3& p : kSquare) mesh.positions.push_back(p);
  for (std::size_t i = 6; i < 12; ++i) mesh.corners[i] += 4;  // with vertices of its own
  const MeshCloth cloth = sound(mesh);
  CHECK(cloth.counts.double_faces == 2);
  CHECK(cloth.counts.non_manifold_edges == 0);
  CHECK(cloth.scene.bending.size() == 1);
}

TEST_CASE("two layers that are sewn at all corners remain two") {
  auto mesh = mesh_of(kSquare, {{0, 1, 2, 3}, {3, 2, 1, 0}});
  for (const Vec3& p : kSquare) mesh.rest_corners.push_back({p.x, p.y});
  for (const Vec3& p : kSquare) mesh.rest_corners.push_back({5 + p.x, p.y});
  CHECK(sound(mesh).counts.double_faces == 0);
  CHECK(area_of(sound(mesh).scene, *mesh.material) == doctest::Approx(2));
}

TEST_CASE("closed surfaces, corners of three quads, a twisted band and folds are cloth") {
  const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  CHECK(
      sound(
          mesh_of(
              cube,
              {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}))
          .counts.quads == 6);
  CHECK(sound(mesh_of({kSquare[0], kSquare[1], kSquare[2], {0, 0, 1}},
                      {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}))
            .counts.triangles == 4);
  CHECK(sound(mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.9, 0}}, {{0, 1, 2}, {0, 3, 1}}))
            .scene.bending.size() == 1);
  MeshDescription band;
  std::vector<std::vector<std::uint32_t>> faces;
  std::vector<Vec3> positions;
  const std::uint32_t around = 20;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    for (const double side : {-0.2, 0.2}) {
      const double radius = 1 + side * std::cos(angle / 2);
      positions.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)});
    }
    const std::uint32_t a = 2 * i, b = a + 1;
    if (i + 1 < around) {
      faces.push_back({a, a + 2, b + 2, b});
    } else {
      faces.push_back({a, 1, 0, b});
    }
  }
  CHECK(sound(mesh_of(positions, faces)).counts.pieces == 1);
}

TEST_CASE("whatever the faces are, there is a sound cloth or one line that says why not") {
  Random random(77);
  int cloths = 0;
  for (int i = 0; i < 400; ++i) {
    MeshDescription mesh;
    const std::uint32_t vertices = 3 + random.below(12);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      const auto on_grid = [&] { return 0.5 * random.below(4); };
      mesh.positions.push_back(random.below(2) == 0 ? Vec3{on_grid(), on_grid(), on_grid()}
                                                    : random.in_box(1));
    }
    for (std::uint32_t f = 0; f < 1 + random.below(15); ++f) {
      mesh.face_sizes.push_back(3 + random.below(4));
      for (std::uint32_t c = 0; c < mesh.face_sizes.back(); ++c) {
        mesh.corners.push_back(random.below(vertices));
      }
    }
    if (random.below(3) == 0) mesh.weld_distance = 0.3;
    if (random.below(3) == 0) mesh.seams = {{0, random.below(vertices)}};
    if (random.below(4) > 0) mesh.material = plain_material();
    const auto cloth = cloth_from_mesh(mesh);
    if (!cloth) {
      CHECK(cloth.error().find('\n') == std::string::npos);
      continue;
    }
    const auto model = build_model(cloth.value().scene);
    CHECK_MESSAGE(model, model.error());
    ++cloths;
  }
  CHECK(cloths > 100);
}

}  // namespace
}  // namespace weft::test::engine_mesh_unsound
