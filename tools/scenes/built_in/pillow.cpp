/// Two level sheets, 1 cm apart and sewn together along their borders, 0.3 m above a floor. A
/// pressure of 50 Pa between them blows them up as they fall.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

/// The lower sheet faces downwards. At rest both lie side by side.
Layout pillow_layout(const Options& options) {
  constexpr double kHeight = 0.3, kHalfGap = 0.005, kApart = 2;  // m
  const Grid grid{options.size};
  Layout layout;
  for (const double side : {1.0, -1.0}) {
    const auto place = [&](int i, int j) {
      return Vec3{grid.fraction(i), kHeight + side * kHalfGap, grid.fraction(j)};
    };
    add_sheet(grid.size, grid.size, place, layout);
    for (const Vec3 at : flat(grid)) layout.rest.push_back({at.x - kApart * side, 0, at.z});
  }
  const auto lower = layout.faces.begin() + static_cast<std::ptrdiff_t>(layout.faces.size() / 2);
  std::for_each(lower, layout.faces.end(), [](Face& face) { std::ranges::reverse(face); });
  const auto count = static_cast<std::uint32_t>(grid.size * grid.size);
  const int last = grid.size - 1;
  for (int i = 0; i <= last; ++i) {
    for (int j = 0; j <= last; ++j) {
      const bool is_border = i == 0 || j == 0 || i == last || j == last;
      if (is_border) layout.seams.push_back({grid.number(i, j), count + grid.number(i, j)});
    }
  }
  add_floor(0, layout);
  return layout;
}

Result<Scene> make_pillow(const Options& options) {
  auto scene = cloth<pillow_layout>(options);
  if (scene) scene.value().description.pressures = {{.pressure = 50}};
  return scene;
}

}  // namespace

BuiltIn pillow() {
  return {.summary = "two sewn sheets of cotton are blown up and fall on a floor",
          .is_fabric = true,
          .smallest_size = 3,
          .make = make_pillow};
}

}  // namespace weft::scenes::built_in
