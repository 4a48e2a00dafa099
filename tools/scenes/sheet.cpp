#include "tools/scenes/sheet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace weft::scenes {

Layout level_sheet(int size) {
  const Grid grid{size};
  return grid_sheet(size, [&](int i, int j) {
    return Vec3{grid.fraction(i), 0, grid.fraction(j)};
  });
}

std::vector<Vec3> flat(const Grid& grid) { return level_sheet(grid.size).start; }

std::vector<Vec3> flat(int rows, int columns, double spacing) {
  std::vector<Vec3> points;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) points.push_back({spacing * i, 0, spacing * j});
  }
  return points;
}

std::vector<std::uint32_t> first_row(const Grid& grid) {
  std::vector<std::uint32_t> row;
  for (int j = 0; j < grid.size; ++j) row.push_back(grid.number(0, j));
  return row;
}

Layout hanging_sheet(int size) {
  Layout layout = level_sheet(size);
  layout.pins = first_row(*layout.grid);
  return layout;
}

Layout sheet_on_table(int size, double friction) {
  constexpr double kHeight = 1e-3, kCovered = 0.4, kTable = 1;  // m
  Layout layout = level_sheet(size);
  for (Vec3& x : layout.start) x.y = kHeight;
  layout.bodies.push_back({.shape = box({kTable, kTable, 1.4}),
                           .position = {kCovered - kTable / 2, -kTable / 2, 0.5},
                           .friction = friction});
  return layout;
}

Vec3 zigzag(double s, double straight, double radius) {
  const double turn = std::numbers::pi * radius, part = straight + turn;
  const int layer = std::min(static_cast<int>(s / part), 3);
  const double along = s - layer * part, side = layer % 2 == 0 ? 1 : -1, base = 2 * radius * layer;
  const double end = straight / 2;  // of the straight part, from the middle
  if (along <= straight || layer == 3) return {side * (along - end), base, 0};
  const double angle = (along - straight) / radius;
  return {side * (end + radius * std::sin(angle)), base + radius * (1 - std::cos(angle)), 0};
}

void add_floor(double height, Layout& layout) {
  layout.bodies.push_back({.shape = Plane{{0, 1, 0}, height}});
}

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

}  // namespace weft::scenes
