/// Sheets that lie on each other, and the pairs of their features that are near.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/vectors.h"

namespace weft::perf {

inline constexpr double kLayerThickness = 2e-3;  // m

/// A point and a triangle, or two edges.
struct LayerPair {
  bool edges = false;
  std::array<std::uint32_t, 4> points{};
  /// Third corners of the faces beside, as simd::ContactBlock has them.
  std::array<std::uint32_t, 4> beside{};
  std::array<bool, 3> is_border{};  // of a triangle: its sides
  double distance = 0;              // m
};

/// Five sheets of size x size points, cells of 2 cm in two triangles, of 0.15 kg/m^2. Each is
/// turned by 0.1 rad against the one under it, and wavy by a tenth of the thickness, so that half
/// of what is near touches. The lowest is fixed.
struct Layers {
  std::vector<kernels::Vector> points;
  std::vector<double> inverse_mass;   // 1/kg
  std::vector<LayerPair> candidates;  // whose boxes, wider by a quarter of a cell, meet
  std::vector<LayerPair> near;        // of these what is nearer than 1.3 thicknesses
};
Layers make_layers(int size);

}  // namespace weft::perf
