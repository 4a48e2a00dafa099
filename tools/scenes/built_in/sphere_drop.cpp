/// The rows j = 0 and j = N-1 are fixed, 1 - slack apart along z; between them the sheet sags as a
/// circular arc of chords of length L. A free sphere of radius 0.15 begins with its lowest point
/// 0.3 above the middle of the sheet, which is its lowest place.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

/// A circular arc of `edges` chords, each 1/edges long and turned by theta against the one before,
/// spans sin(edges * theta / 2) / (edges * sin(theta / 2)): 1 when straight, falling to 0 when the
/// arc has closed to a whole polygon at theta = 2 pi / edges.
double turning_angle(int edges, double span) {
  const auto spanned = [edges](double theta) {
    return std::sin(edges * theta / 2) / (edges * std::sin(theta / 2));
  };
  double straighter = 0;
  double rounder = 2 * std::numbers::pi / edges;
  for (;;) {
    const double theta = std::midpoint(straighter, rounder);
    if (theta == straighter || theta == rounder) return theta;
    (spanned(theta) > span ? straighter : rounder) = theta;
  }
}

/// The corners of the arc in the y-z plane, from z = 0 to z = 1 - slack, sagging towards -y.
std::vector<Vec3> sagging_arc(const Grid& grid, double slack) {
  const int edges = grid.size - 1;
  const double theta = slack > 0 ? turning_angle(edges, 1 - slack) : 0.0;
  std::vector<Vec3> corners{{0, 0, 0}};
  for (int k = 0; k < edges; ++k) {
    const double slope = (k - (edges - 1) / 2.0) * theta;
    const Vec3 last = corners.back();
    corners.push_back(
        {0, last.y + grid.spacing() * std::sin(slope), last.z + grid.spacing() * std::cos(slope)});
  }
  return corners;
}

Result<Layout> sphere_drop_layout(const Options& options) {
  constexpr double kRadius = 0.15;
  constexpr double kDrop = 0.3;
  if (auto checked = check_mass("sphere_mass", options.sphere_mass); !checked)
    return Error{checked.error()};
  if (!(options.slack >= 0 && options.slack < 1))
    return refused("slack", "at least 0 and below 1", options.slack);
  const Grid grid{options.size};
  const std::vector<Vec3> arc = sagging_arc(grid, options.slack);
  Layout layout = grid_sheet(options.size, [&](int i, int j) {
    const Vec3 corner = arc[static_cast<std::size_t>(j)];
    return Vec3{grid.fraction(i), corner.y, corner.z};
  });
  layout.rest = flat(grid);
  for (int i = 0; i < grid.size; ++i) {
    layout.pins.push_back(grid.number(i, 0));
    layout.pins.push_back(grid.number(i, grid.size - 1));
  }
  const double middle = arc[arc.size() / 2].y;
  layout.sphere = {.centre = {0.5, middle + kDrop + kRadius, (1 - options.slack) / 2},
                   .radius = kRadius,
                   .mass = options.sphere_mass,
                   .is_fixed = false};
  return layout;
}

}  // namespace

BuiltIn sphere_drop() {
  return {.summary = "a heavy sphere drops into a sagging sheet",
          .smallest_size = 3,
          .make = cloth<sphere_drop_layout>};
}

}  // namespace weft::scenes::built_in
