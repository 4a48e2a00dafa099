/// Cloth that is sewn while it touches itself: seams close as they do without self-contact, since
/// what is sewn together, or will be, does not keep apart.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_sewn_layers {
namespace {

constexpr double kWidth = 0.24;  // m, of a panel

using Seams = std::vector<std::array<std::uint32_t, 2>>;

/// Two panels of side by side vertices, by place(panel, row, column) with rows and columns from 0
/// to 1. seams: vertices of one panel that are sewn to the same ones of the other.
SceneDescription panels(std::uint32_t side, Cut cut, const char* material,
                        const std::function<Vec3(int panel, double row, double column)>& place,
                        const Seams& seams, double time = 1) {
  const auto panel = [&](int which) {
    return sheet(
        side, side,
        [&](double row, double column) {
          return place(which, row / (side - 1), column / (side - 1));
        },
        [cut](std::uint32_t row, std::uint32_t column) {
          return cut == Cut::first && (row + column) % 2 == 0 ? Cut::second : cut;
        });
  };
  MeshDescription mesh = panel(0);
  const MeshDescription other = panel(1);
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const std::uint32_t corner : other.corners) mesh.corners.push_back(corner + count);
  mesh.face_sizes.insert(mesh.face_sizes.end(), other.face_sizes.begin(), other.face_sizes.end());
  for (const auto& [a, b] : seams) mesh.seams.push_back({a, b + count});
  mesh.seam_time = time;
  mesh.material = find_material(material).value();
  SceneDescription scene = made(mesh).scene;
  scene.self_contact.on = true;
  return scene;
}

/// One beside the other, hanging; sewn along the borders that are next to each other.
SceneDescription side_by_side(std::uint32_t side, Cut cut, const char* material) {
  Seams seams;
  for (std::uint32_t row = 0; row < side; ++row)
    seams.push_back({side * row + side - 1, side * row});
  SceneDescription scene = panels(
      side, cut, material,
      [](int panel, double row, double column) {
        return Vec3{kWidth * column + panel * (kWidth + 0.03), -kWidth * row, 0};
      },
      seams);
  scene.fixed = {0, side * side + side - 1};
  return scene;
}

/// Over each other, falling; sewn around three sides, and in the middle.
SceneDescription bag(std::uint32_t side, Cut cut, const char* material) {
  Seams seams;
  for (std::uint32_t i = 0; i < side; ++i) {
    seams.push_back({side * i, side * i});
    seams.push_back({side * i + side - 1, side * i + side - 1});
    if (i > 0 && i + 1 < side) seams.push_back({i, i});
  }
  const std::uint32_t middle = side * (side / 2) + side / 2;
  seams.push_back({middle, middle});
  return panels(
      side, cut, material,
      [](int panel, double row, double column) {
        return Vec3{kWidth * column, 0.02 * panel, kWidth * row};
      },
      seams);
}

double widest_gap(const Cloth& cloth, const SceneDescription& scene) {
  double widest = 0;
  for (const Seam& seam : scene.seams)
    widest = std::max(widest, distance(cloth.position(seam.a), cloth.position(seam.b)));
  return widest;
}

void check_closes(const SceneDescription& scene, int rate) {
  Cloth cloth = cloth_of(scene, {.threads = 1});
  for (int frame = 1; frame <= rate + rate / 5; ++frame) {
    const StepReport report = step(cloth, 1.0 / rate);
    CAPTURE(frame);
    CHECK(report.status == Status::converged);
    CHECK(report.late_seams == 0);
    CHECK(report.tangled == 0);
    if (frame < rate) continue;
    CHECK(report.open_seams == 0);
    CHECK(widest_gap(cloth, scene) <= 1e-4);
  }
}

void for_each_scene(const std::function<void(const SceneDescription&, int rate)>& check) {
  for (const char* material : {"cotton", "denim"}) {
    for (const auto& [side, cut] : {std::pair{7u, Cut::none}, std::pair{11u, Cut::first}}) {
      for (const int rate : {30, 60, 240}) {
        CAPTURE(std::string(material));
        CAPTURE(side);
        CAPTURE(rate);
        check(side_by_side(side, cut, material), rate);
        check(bag(side, cut, material), rate);
      }
    }
  }
}

TEST_CASE("seams close in their time where cloth touches itself" * doctest::test_suite("long")) {
  for_each_scene(check_closes);
}

TEST_CASE(
    "what is sewn falls as without self-contact, however long its edges are beside the thickness") {
  const std::uint32_t kSide = 9;
  Seams seams;
  for (std::uint32_t row = 0; row < kSide; ++row)
    seams.push_back({kSide * row + kSide - 1, kSide * row});
  // What is a micrometre apart is not welded, and closed when the cloth is made.
  SceneDescription scene = panels(
      kSide, Cut::none, "cotton",
      [](int panel, double row, double column) {
        return Vec3{0.03 * (column + panel) + 1e-6 * panel, 0, 0.03 * row};
      },
      seams);
  for (const double edges : {0.9, 2.0, 4.0}) {
    CAPTURE(edges);
    scene.self_contact.thickness = edges * 0.03 / (kSide - 1);
    scene.self_contact.on = true;
    Cloth cloth = cloth_of(scene, {.threads = 1});
    scene.self_contact.on = false;
    Cloth alone = cloth_of(scene, {.threads = 1});
    for (int frame = 0; frame < 8; ++frame) {
      const StepReport report = step(cloth, 1.0 / 60);
      CHECK(report.status == Status::converged);
      CHECK(report.open_seams == 0);
    }
    run(alone, 1.0 / 60, 8);
    CHECK(largest_distance(positions(cloth), positions(alone)) < 1e-5);
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_sewn_layers
