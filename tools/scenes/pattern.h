/// Patterns of clothes: flat panels, and what is sewn to what. A pattern can be cut at any
/// resolution.
#pragma once

#include <weft/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/triangulation.h"

namespace weft::scenes {

/// A curve in the plane, for t from 0 to 1.
using Curve = std::function<Point(double t)>;
Curve line(Point from, Point to);
/// From one point to another, towards the third and away from it (a quadratic Bezier curve).
Curve bent(Point from, Point towards, Point to);
/// Around a centre; angles in rad, counterclockwise from the x axis.
Curve arc(Point centre, double radius, double from, double to);

/// Counterclockwise around the panel; each edge ends where the next one begins.
using Panel = std::vector<Curve>;

struct PanelEdge {
  std::size_t panel = 0, edge = 0;
};
struct PanelSeam {
  PanelEdge one, other;
  bool opposite = false;  ///< the start of one is sewn to the end of the other
};

struct Pattern {
  std::vector<Panel> panels;  ///< m; y is along the warp
  std::vector<PanelSeam> seams;
};

/// Panels cut into triangles. Each panel has its own vertices.
struct CutPattern {
  std::vector<Point> flat;                                     ///< m, of each vertex in its panel
  std::vector<std::size_t> panel;                              ///< of each vertex
  std::vector<Face> faces;                                     ///< counterclockwise in the plane
  std::vector<std::array<std::uint32_t, 2>> seams;             ///< vertices that are sewn together
  std::vector<std::vector<std::vector<std::uint32_t>>> edges;  ///< vertices along each, with ends
};

/// Vertices are about `spacing` apart. Edges that are sewn together have as many vertices as each
/// other, however long they are. The error says which panel is too small for the spacing.
Result<CutPattern> cut(const Pattern& pattern, double spacing);

}  // namespace weft::scenes
