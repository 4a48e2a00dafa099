#include "tools/scenes/layered_layouts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "tools/scenes/body_meshes.h"
#include "tools/scenes/grid_layouts.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes {
namespace {

using tools::PinMove;

void add_floor(double height, Layout& layout) {
  layout.bodies.push_back({.shape = Plane{{0, 1, 0}, height}});
}

void lay_flat(int rows, int columns, double spacing, Layout& layout) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) layout.rest.push_back({spacing * i, 0, spacing * j});
  }
}

/// So many points along a curve in the plane of x and y, each as far from the one before.
std::vector<Vec3> chords(int count, double chord, const std::function<Vec3(double)>& curve) {
  const auto apart = [](Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y); };
  double at = 0;  // m, along it
  std::vector<Vec3> points{curve(0)};
  while (points.size() < static_cast<std::size_t>(count)) {
    const Vec3 last = points.back();
    double far = at + chord;
    while (apart(last, curve(far)) < chord) far += chord / 32;
    double near = std::max(at, far - chord / 32);
    for (int i = 0; i < 60; ++i) {
      const double middle = (near + far) / 2;
      (apart(last, curve(middle)) < chord ? near : far) = middle;
    }
    at = far;
    points.push_back(curve(at));
  }
  return points;
}

/// Like a letter: straight parts to and fro, one over another, joined by half circles.
Vec3 zigzag(double s, double straight, double radius) {
  const double turn = std::numbers::pi * radius, part = straight + turn;
  const int layer = std::min(static_cast<int>(s / part), 3);
  const double along = s - layer * part, side = layer % 2 == 0 ? 1 : -1, base = 2 * radius * layer;
  const double end = straight / 2;  // of the straight part, from the middle
  if (along <= straight || layer == 3) return {side * (along - end), base, 0};
  const double angle = (along - straight) / radius;
  return {side * (end + radius * std::sin(angle)), base + radius * (1 - std::cos(angle)), 0};
}

}  // namespace

Layout stack(const Options& options) {
  constexpr int kLayers = 5;
  constexpr double kApart = 0.01, kTurn = 0.1;  // m, rad
  const Grid grid{options.size};
  Layout layout;
  for (int layer = 0; layer < kLayers; ++layer) {
    const double c = std::cos(kTurn * layer), s = std::sin(kTurn * layer);
    const auto place = [&](int i, int j) {
      const double x = grid.fraction(i) - 0.5, z = grid.fraction(j) - 0.5;
      return Vec3{c * x + s * z, kApart * (layer + 1), c * z - s * x};
    };
    add_sheet(grid.size, grid.size, place, layout);
  }
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

Layout fold(const Options& options) {
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
  lay_flat(grid.size, grid.size, grid.spacing(), layout);
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

Layout curtain(const Options& options) {
  constexpr double kTable = 0.6, kFriction = 0.03;  // m, above the floor
  Layout layout = table(options);
  layout.bodies.front().friction = kFriction;
  add_floor(-kTable, layout);
  layout.touches_itself = true;
  return layout;
}

Layout twist(const Options& options) {
  constexpr double kWidth = 0.2, kNearer = 0.2;  // m
  constexpr double kTurns = 3, kEnd = 6;         // of one end against the other; s
  constexpr int kKeys = 60;
  const Grid grid{options.size};
  const int columns = std::max(3, 1 + static_cast<int>(std::lround(kWidth / grid.spacing())));
  const double width = grid.spacing() * (columns - 1);
  Layout layout;
  const auto place = [&](int i, int j) {
    return Vec3{grid.fraction(i) - 0.5, 0, grid.spacing() * j - width / 2};
  };
  add_sheet(grid.size, columns, place, layout);
  for (const double side : {-1.0, 1.0}) {
    PinMove move;
    for (int j = 0; j < columns; ++j)
      move.particles.push_back(
          static_cast<std::uint32_t>(side < 0 ? j : (grid.size - 1) * columns + j));
    for (int key = 0; key <= kKeys; ++key) {
      const double share = static_cast<double>(key) / kKeys;
      move.times.push_back(kEnd * share);
      move.rotations.push_back({side * std::numbers::pi * kTurns * share, 0, 0});
      move.translations.push_back({-side * kNearer / 2 * share * share, 0, 0});
    }
    layout.pins.insert(layout.pins.end(), move.particles.begin(), move.particles.end());
    layout.moves.push_back(move);
  }
  layout.touches_itself = true;
  return layout;
}

Layout ribbon(const Options& options) {
  constexpr double kLength = 2, kWidth = 0.125;                  // m
  constexpr double kHeight = 0.02, kLowered = 1.9;               // m
  constexpr double kWave = 0.005, kWavelength = 0.25, kEnd = 5;  // m, m, s
  const Grid grid{options.size};
  const int rows = 1 + static_cast<int>(kLength) * (grid.size - 1);
  const int columns = std::max(2, 1 + static_cast<int>(std::lround(kWidth / grid.spacing())));
  const std::vector<Vec3> line = chords(rows, grid.spacing(), [&](double s) {
    return Vec3{kWave * std::sin(2 * std::numbers::pi * s / kWavelength), kHeight + s, 0};
  });
  Layout layout;
  const auto place = [&](int i, int j) {
    const Vec3 at = line[static_cast<std::size_t>(i)];
    return Vec3{at.x, at.y, grid.spacing() * j};
  };
  add_sheet(rows, columns, place, layout);
  lay_flat(rows, columns, grid.spacing(), layout);
  PinMove move{.times = {0, kEnd}, .translations = {{}, {0, -kLowered, 0}}};
  for (int j = 0; j < columns; ++j)
    move.particles.push_back(static_cast<std::uint32_t>((rows - 1) * columns + j));
  layout.pins = move.particles;
  layout.moves.push_back(move);
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

Layout funnel(const Options& options) {
  constexpr double kRing = 0.16, kTube = 0.02, kClearance = 0.01;  // m, middle to middle; radius
  constexpr double kHeld = 0.1, kWay = 1, kEnd = 6;                // m, m, s
  const Grid grid{options.size};
  Layout layout;
  const auto place = [&](int i, int j) {
    return Vec3{grid.fraction(i) - 0.5, kTube + kClearance, grid.fraction(j) - 0.5};
  };
  add_sheet(grid.size, grid.size, place, layout);
  PinMove move{.times = {0, kEnd}, .translations = {{}, {0, -kWay, 0}}};
  for (std::uint32_t v = 0; v < layout.start.size(); ++v) {
    const Vec3 at = layout.start[v];
    if (std::hypot(at.x, at.z) < kHeld) move.particles.push_back(v);
  }
  layout.pins = move.particles;
  layout.moves.push_back(move);
  layout.bodies.push_back({.shape = ring_mesh(kRing, kTube, 48, 12), .friction = 0.1});
  layout.touches_itself = true;
  return layout;
}

}  // namespace weft::scenes
