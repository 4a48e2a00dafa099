#include "tools/scenes/grid_layouts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "tools/scenes/sheet.h"

namespace weft::scenes {
namespace {

/// place(i, j) is where the vertex (i, j) begins.
template <class Place>
Layout sheet(int size, Place place) {
  Layout layout;
  layout.grid = Grid{size};
  add_sheet(size, size, place, layout);
  return layout;
}

/// The same vertices, flat.
std::vector<Vec3> flat(const Grid& grid) {
  std::vector<Vec3> points;
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) points.push_back({grid.fraction(i), 0, grid.fraction(j)});
  }
  return points;
}

Layout level_sheet(int size) {
  const Grid grid{size};
  return sheet(size, [&](int i, int j) { return Vec3{grid.fraction(i), 0, grid.fraction(j)}; });
}

/// All (0, j).
std::vector<std::uint32_t> first_row(const Grid& grid) {
  std::vector<std::uint32_t> row;
  for (int j = 0; j < grid.size; ++j) row.push_back(grid.number(0, j));
  return row;
}

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

}  // namespace

Layout hang(const Options& options) {
  Layout layout = level_sheet(options.size);
  layout.pins = first_row(*layout.grid);
  return layout;
}

Layout hang_sphere(const Options& options) {
  Layout layout = hang(options);
  layout.sphere = {.centre = {0.5, -0.6, 0.5}, .radius = 0.25};
  return layout;
}

/// The sphere's lowest point starts 0.3 m above the middle of the sheet, which is its lowest place.
Layout sphere_drop(const Options& options) {
  constexpr double kRadius = 0.15;
  constexpr double kDrop = 0.3;
  const Grid grid{options.size};
  const std::vector<Vec3> arc = sagging_arc(grid, options.slack);
  Layout layout = sheet(options.size, [&](int i, int j) {
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

/// The sheet starts folded along its middle row, every edge at its rest length, and hangs from two
/// corners: all of its weight runs through the whole sheet.
Layout corners(const Options& options) {
  constexpr double kSpan = 0.9;
  const double fall = std::sqrt(1 - kSpan * kSpan);
  const Grid grid{options.size};
  Layout layout = sheet(options.size, [&](int i, int j) {
    const double along = grid.fraction(j);
    const double to_border = grid.fraction(std::min(j, grid.size - 1 - j));
    return Vec3{grid.fraction(i), -fall * to_border, kSpan * along};
  });
  layout.rest = flat(grid);
  layout.pins = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  return layout;
}

Layout banner(const Options& options) {
  const Grid grid{options.size};
  Layout layout = sheet(options.size, [&](int i, int j) {
    return Vec3{0, -grid.fraction(i), grid.fraction(j)};
  });
  layout.pins = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  return layout;
}

Layout four_pins(const Options& options) {
  Layout layout = level_sheet(options.size);
  const Grid grid = *layout.grid;
  const int last = grid.size - 1;
  layout.pins = {grid.number(0, 0), grid.number(0, last), grid.number(last, 0),
                 grid.number(last, last)};
  return layout;
}

Layout flag(const Options& options) {
  const Grid grid{options.size};
  Layout layout = sheet(options.size, [&](int i, int j) {
    return Vec3{grid.fraction(i), -grid.fraction(j), 0};
  });
  layout.pins = first_row(grid);
  layout.wind = {8, 0, 2};
  return layout;
}

Layout drape(const Options& options) {
  constexpr double kRadius = 0.3, kClearance = 0.01;
  Layout layout = level_sheet(options.size);
  layout.sphere = {.centre = {0.5, -kRadius - kClearance, 0.5}, .radius = kRadius};
  return layout;
}

Layout table(const Options& options) {
  constexpr double kHeight = 1e-3, kCovered = 0.4, kTable = 1;  // m
  Layout layout = level_sheet(options.size);
  for (Vec3& x : layout.start) x.y = kHeight;
  layout.bodies.push_back({.shape = box({kTable, kTable, 1.4}),
                           .position = {kCovered - kTable / 2, -kTable / 2, 0.5},
                           .friction = 0.2});
  return layout;
}

/// It hangs in slight waves, so that it knows where to fold.
Layout rings(const Options& options) {
  constexpr int kRings = 8, kWaves = 8;
  constexpr double kWave = 0.005, kPulled = 0.6, kFriction = 0.2;  // m, m, 1
  const Grid grid{options.size};
  const int last = grid.size - 1;
  Layout layout = sheet(options.size, [&](int i, int j) {
    const double wave = kWave * std::sin(2 * M_PI * kWaves * grid.fraction(j)) * grid.fraction(i);
    return Vec3{grid.fraction(j), -grid.fraction(i), wave};
  });
  Rod rod{{-0.1, 0, 0}, {1.1, 0, 0}, kFriction};
  for (int k = 1; k < kRings; ++k) rod.rings.push_back(grid.number(0, k * last / kRings));
  layout.rod = rod;
  layout.pins = {grid.number(0, 0), grid.number(0, last)};
  layout.moves.push_back({.particles = {grid.number(0, last)},
                          .times = {0.2, 1.7, 2.2, 3.7},
                          .translations = {{}, {-kPulled, 0, 0}, {-kPulled, 0, 0}, {}}});
  layout.touches_itself = true;
  return layout;
}

Layout cushion(const Options& options) {
  constexpr double kRadius = 0.15, kThickness = 1e-3, kDepth = 0.06, kWay = 0.2;  // m
  constexpr double kHeight = kRadius + kThickness, kTurn = kWay / kRadius;        // rad
  Layout layout = level_sheet(options.size);
  const Grid grid = *layout.grid;
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) {
      const bool is_inner = i > 0 && j > 0 && i + 1 < grid.size && j + 1 < grid.size;
      if (!is_inner) layout.pins.push_back(grid.number(i, j));
    }
  }
  const Vec3 from{0.5 - kWay / 2, kHeight, 0.5};
  const tools::PinMove move{
      .times = {0, 1, 2, 3},
      .translations = {{}, {0, -kDepth, 0}, {kWay, -kDepth, 0}, {0, -kDepth, 0}},
      .rotations = {{}, {}, {0, 0, -kTurn}, {0, 0, -kTurn}},
      .about = from};
  layout.bodies.push_back({.shape = weft::Ball{.radius = kRadius},
                           .position = from,
                           .thickness = kThickness,
                           .friction = 0.4,
                           .move = move});
  return layout;
}

}  // namespace weft::scenes
