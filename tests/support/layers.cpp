#include "tests/support/layers.h"

#include <algorithm>
#include <cmath>

#include "tests/support/vectors.h"

namespace weft::test {

using Triangle = std::array<std::uint32_t, 3>;

SceneDescription scene_of(const std::vector<Sheet>& sheets, double friction,
                          const std::vector<std::uint32_t>& pins) {
  MeshDescription mesh;
  for (const Sheet& sheet : sheets) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= sheet.rows; ++i) {
      for (std::uint32_t j = 0; j <= sheet.columns; ++j) {
        mesh.positions.push_back(sheet.place(static_cast<double>(i) / sheet.rows,
                                             static_cast<double>(j) / sheet.columns));
      }
    }
    const std::uint32_t row = sheet.columns + 1;
    for (std::uint32_t i = 0; i < sheet.rows; ++i) {
      for (std::uint32_t j = 0; j < sheet.columns; ++j) {
        const std::uint32_t at = first + i * row + j;
        mesh.face_sizes.push_back(4);
        for (const std::uint32_t corner : {at, at + row, at + row + 1, at + 1})
          mesh.corners.push_back(corner);
      }
    }
  }
  mesh.material = find_material("cotton").value();
  mesh.pins = pins;
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.air = {};
  scene.self_contact = {.on = true, .thickness = kLayerThickness, .friction = friction};
  return scene;
}

double chance(double u, double v) {
  const double s = 43758.5453 * std::sin(127.1 * u + 311.7 * v);
  return s - std::floor(s) - 0.5;
}

std::vector<Sheet> stack(std::uint32_t layers, std::uint32_t cells, double apart) {
  std::vector<Sheet> sheets;
  for (std::uint32_t layer = 0; layer < layers; ++layer) {
    sheets.push_back({cells, cells, [=](double u, double v) {
                        const double turn = 0.15 * layer, x = 0.4 * (u - 0.5), z = 0.4 * (v - 0.5);
                        return Vec3{std::cos(turn) * x - std::sin(turn) * z, apart * (layer + 1),
                                    std::sin(turn) * x + std::cos(turn) * z};
                      }});
  }
  return sheets;
}

namespace {

double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(cross(a - d, b - d), c - d); }

bool leads_through(Vec3 from, Vec3 to, const std::array<Vec3, 3>& t) {
  if ((volume(t[0], t[1], t[2], from) > 0) == (volume(t[0], t[1], t[2], to) > 0)) return false;
  const double turns[] = {volume(from, to, t[0], t[1]), volume(from, to, t[1], t[2]),
                          volume(from, to, t[2], t[0])};
  return std::ranges::all_of(turns, [](double turn) { return turn > 0; }) ||
         std::ranges::all_of(turns, [](double turn) { return turn < 0; });
}

}  // namespace

std::size_t count_self_crossings(const std::vector<Vec3>& x,
                                 const std::vector<Triangle>& triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  }
  std::ranges::sort(edges);
  const auto rest = std::ranges::unique(edges);
  edges.erase(rest.begin(), rest.end());
  std::size_t count = 0;
  for (const Triangle& t : triangles) {
    const std::array corners{x[t[0]], x[t[1]], x[t[2]]};
    for (const auto& [a, b] : edges) {
      if (std::ranges::find(t, a) != t.end() || std::ranges::find(t, b) != t.end()) continue;
      if (leads_through(x[a], x[b], corners)) ++count;
    }
  }
  return count;
}

}  // namespace weft::test
