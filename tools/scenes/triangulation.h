/// Triangles of about one size over a flat region.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace weft::scenes {

struct Point {
  double x = 0, y = 0;
};

struct Triangulation {
  std::vector<Point> points;  ///< those of the border first, in their order
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counterclockwise
};

/// The Delaunay triangles of the points of a border and of points within it, which lie about
/// `spacing` apart and are moved by chance, so that no two triangles are alike. The border is given
/// counterclockwise, its points about `spacing` apart; its segments are edges of triangles. Nothing
/// where that fails, as it does where parts of the border come too near to one another. The same on
/// every machine.
std::optional<Triangulation> triangulate(const std::vector<Point>& border, double spacing);

}  // namespace weft::scenes
