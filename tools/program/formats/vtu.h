/// VTK's XML files, as ParaView and VTK read them: one unstructured grid of points, triangles and
/// lines, with named numbers at each point and in each cell, and a collection of such files over
/// time.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace weft::tools {

struct VtuArray {
  std::string name;            ///< without quotes and signs of XML
  int components = 1;          ///< of each tuple
  std::vector<double> values;  ///< tuple by tuple
};

struct VtuGrid {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines;
  std::vector<VtuArray> of_points;
  std::vector<VtuArray> of_cells;  ///< of the triangles, then of the lines
};

/// The bytes of a .vtu file: numbers stand behind the text, as they are in memory (little-endian).
std::string vtu_bytes(const VtuGrid& grid);

/// The text of a .pvd file: time (s) and name of each .vtu file.
std::string pvd_text(const std::vector<std::pair<double, std::string>>& files);

}  // namespace weft::tools
