/// Cloth that air and pressures push.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <vector>

namespace weft::test {

inline constexpr Settings kSmallSteps[] = {
    {.solver = Solver::small_steps, .backend = Backend::reference},
    {.solver = Solver::small_steps, .backend = Backend::simd}};
inline constexpr double kAirDensity = 1.2;  // kg/m^3, of in_air
inline constexpr double kRam = 1.3;
inline constexpr double kBalloonRadius = 0.5;  // m

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles triangles_of(const TriangleMesh& mesh);
/// Nothing holds the particles: each has the mass of a third of its triangles.
SceneDescription loose(const std::vector<Vec3>& positions, const Triangles& triangles,
                       double area_density);
/// A square of 1 m in the plane y = 0, its normal along y.
SceneDescription plate(double area_density);
/// All of it catches the air, which is at rest.
SceneDescription in_air(SceneDescription scene, Vec3 velocity);
/// A triangle whose first two corners are fixed, on the axis z; the third, of 1 kg, is 1 m off it.
SceneDescription flap();
/// A balloon of fabric, 0.2 kg/m^2, at rest.
SceneDescription balloon(int level, double stiffness, double damping);

}  // namespace weft::test
