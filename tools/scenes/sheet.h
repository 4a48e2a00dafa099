/// Sheets of cells with four corners.
#pragma once

#include <cstdint>

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

}  // namespace weft::scenes
