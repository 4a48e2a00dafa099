/// Sheets of cells with four corners, and where several scenes begin with them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tools/scenes/layout.h"

namespace weft::scenes {

/// Adds rows x columns vertices, row by row, and the cells between them. place(i, j) is where the
/// vertex j of the row i begins.
template <class Place>
void add_sheet(int rows, int columns, Place place, Layout& layout) {
  const auto first = static_cast<std::uint32_t>(layout.start.size());
  const auto number = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(i * columns + j);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) layout.start.push_back(place(i, j));
  }
  for (int i = 0; i + 1 < rows; ++i) {
    for (int j = 0; j + 1 < columns; ++j)
      layout.faces.push_back(
          {number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)});
  }
}

/// A grid of N x N; place(i, j) is where the vertex (i, j) begins.
template <class Place>
Layout grid_sheet(int size, Place place) {
  Layout layout;
  layout.grid = Grid{size};
  add_sheet(size, size, place, layout);
  return layout;
}

/// (i, j) at (i L, 0, j L).
Layout level_sheet(int size);
/// The same places, for a sheet that is flat at rest and begins in another shape.
std::vector<Vec3> flat(const Grid& grid);
/// Rows and columns that are flat at rest, for a sheet that is no grid.
std::vector<Vec3> flat(int rows, int columns, double spacing);

/// All (0, j).
std::vector<std::uint32_t> first_row(const Grid& grid);

/// A level sheet whose row i = 0 is fixed.
Layout hanging_sheet(int size);
/// A level sheet on the top of a box that carries the first 0.4 m of it.
Layout sheet_on_table(int size, double friction);

/// Straight parts to and fro, four at most and one over another, joined by half circles: the point
/// after the length `s`, in the plane of x and y.
Vec3 zigzag(double s, double straight, double radius);

void add_floor(double height, Layout& layout);

/// So many points along a curve in the plane of x and y, each as far from the one before.
std::vector<Vec3> chords(int count, double chord, const std::function<Vec3(double)>& curve);

}  // namespace weft::scenes
