#include "tests/support/layers.h"

#include <cmath>

#include "tests/support/vectors.h"

namespace weft::test {

SceneDescription scene_of(const std::vector<Sheet>& sheets, double friction,
                          const std::vector<std::uint32_t>& pins, std::string_view material) {
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
  mesh.material = find_material(material).value();
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

}  // namespace weft::test
