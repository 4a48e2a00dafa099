/// A sheet in four layers, like a letter: three half circles of a radius of 2 cm join them. It
/// falls from 5 cm on a floor. It has self-contact.
#include <cstddef>
#include <numbers>
#include <vector>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout fold_layout(const Options& options) {
  constexpr double kRadius = 0.02, kHeight = 0.05;  // m
  constexpr double kStraight = (1 - 3 * std::numbers::pi * kRadius) / 4;
  const Grid grid{options.size};
  const std::vector<Vec3> line =
      chords(grid.size, grid.spacing(), [&](double s) { return zigzag(s, kStraight, kRadius); });
  Layout layout;
  const auto place = [&](int i, int j) {
    const Vec3 at = line[static_cast<std::size_t>(i)];
    return Vec3{at.x, at.y + kHeight, grid.fraction(j) - 0.5};
  };
  add_sheet(grid.size, grid.size, place, layout);
  layout.rest = flat(grid.size, grid.size, grid.spacing());
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn fold() {
  return {.summary = "a sheet of cotton in four layers falls on a floor",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<fold_layout>};
}

}  // namespace weft::scenes::built_in
