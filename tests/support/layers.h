/// Cloth that touches itself: sheets over each other.
#pragma once

#include <weft/mesh.h>
#include <weft/weft.h>

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace weft::test {

inline constexpr double kLayerThickness = 2e-3;  // m

/// Rows by columns of cells, from 0 to 1 along both; many of them are one scene.
struct Sheet {
  std::uint32_t rows = 0, columns = 0;
  std::function<Vec3(double u, double v)> place;
};
/// Without air, with self-contact.
SceneDescription scene_of(const std::vector<Sheet>& sheets, double friction,
                          const std::vector<std::uint32_t>& pins = {},
                          std::string_view material = "cotton");
/// Between -0.5 and 0.5: the same for the same u and v, and another for each.
double chance(double u, double v);
/// Squares of 0.4 m at rest, each turned a little against the one under it, `apart` from it.
std::vector<Sheet> stack(std::uint32_t layers, std::uint32_t cells, double apart);

}  // namespace weft::test
