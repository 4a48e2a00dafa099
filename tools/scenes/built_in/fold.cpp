/// A sheet in four layers, like a letter: three half circles of a radius of 2 cm join them. It
/// falls from 5 cm on a floor. It has self-contact.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

/// Straight parts to and fro, one over another, joined by half circles.
Vec3 zigzag(double s, double straight, double radius) {
  const double turn = std::numbers::pi * radius, part = straight + turn;
  const int layer = std::min(static_cast<int>(s / part), 3);
  const double along = s - layer * part, side = layer % 2 == 0 ? 1 : -1, base = 2 * radius * layer;
  const double end = straight / 2;  // of the straight part, from the middle
  if (along <= straight || layer == 3) return {side * (along - end), base, 0};
  const double angle = (along - straight) / radius;
  return {side * (end + radius * std::sin(angle)), base + radius * (1 - std::cos(angle)), 0};
}

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
