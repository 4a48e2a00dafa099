/// The program of hanging_sheet.c in C++.
#include <weft/mesh.h>

#include <cinttypes>
#include <cstdio>
#include <string>

namespace {

/// Of 9 x 9 vertices in the plane y = 0, 1 m apart.
weft::MeshDescription sheet() {
  constexpr std::uint32_t kSide = 9;
  weft::MeshDescription mesh;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      mesh.positions.push_back({double(column), 0, double(row)});
      if (row == 0 || column == 0) continue;
      const std::uint32_t last = row * kSide + column;
      mesh.corners.insert(mesh.corners.end(), {last - kSide - 1, last - kSide, last, last - 1});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.pins = {0, kSide - 1};
  return mesh;
}

int fail(const std::string& message) { return std::puts(message.c_str()), 1; }

}  // namespace

int main() {
  const auto made = weft::cloth_from_mesh(sheet());
  if (!made) return fail(made.error());
  const auto model = weft::build_model(made.value().scene);
  if (!model) return fail(model.error());
  auto cloth = weft::Cloth::create(model.value(), {});
  if (!cloth) return fail(cloth.error());
  const auto floor = weft::build_shape(weft::Plane{{0, 1, 0}, -1});
  if (!floor) return fail(floor.error());
  const auto id = cloth.value().add_body({.shape = floor.value()});
  if (!id) return fail(id.error());
  for (int frame = 0; frame < 60; ++frame) {
    const auto report = cloth.value().step(0.01);
    if (!report) return fail(report.error());
  }
  std::printf("%016" PRIx64 "\n", cloth.value().state_hash());
}
