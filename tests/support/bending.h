/// Strips and sheets with bending elements.
#pragma once

#include <weft/weft.h>

#include <cstdint>

namespace weft::test {

/// Segments of one length along x, the last end free, the first end clamped at x = 0: a plate's
/// strip of unit width, with the bending stiffness k (N m) and the density rho (kg/m^2). The clamp
/// is two fixed particles, the second one at x = 0.
struct Strip {
  double length = 0.2;  // m, from the clamp to the free end
  double stiffness = 1e-3;
  double density = 0.2;
  std::uint32_t segments = 8;
};
/// Elements {1, -2, 1}: of curvature kappa = d / dx^2 and energy k kappa^2 dx / 2.
SceneDescription cantilever(const Strip& strip);
/// The same without the clamp.
SceneDescription free_strip(const Strip& strip);

/// The scene with isometric elements of stiffness k over each pair of triangles of its constraints
/// (weft.h).
SceneDescription with_hinges(SceneDescription scene, double stiffness);
/// A scene of n x n particles, numbered row by row, with elements {1, -2, 1} along rows and
/// columns.
SceneDescription with_rows(SceneDescription scene, std::uint32_t n, double stiffness);

}  // namespace weft::test
