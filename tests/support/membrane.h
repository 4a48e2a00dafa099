/// Fabric as triangles (MembraneElement), and what its laws say of it, from their definition.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <vector>

namespace weft::test {

struct Fabric {
  double warp = 400, weft = 250, shear = 40;  // N/m
  double density = 0.2;                       // kg/m^2
  double angle = 0;                           // rad, from x to the warp, about z
  ConstraintKind kind = ConstraintKind::distance;
};

/// One triangle of fabric, in the plane z = 0, with sides of about 0.1 m; no gravity.
SceneDescription fabric_triangle(const Fabric& fabric);
/// cells x cells squares with sides of 0.05 m, each cut along a diagonal by chance; particles
/// inside are moved by up to a third of a side. No gravity.
SceneDescription fabric_patch(const Fabric& fabric, std::uint32_t cells, std::uint32_t seed);
/// Of fabric_patch: those on its outline.
std::vector<std::uint32_t> outline_of(std::uint32_t cells);
/// A patch without gaps or random moves, hung up by its first row; y is down, gravity on.
SceneDescription fabric_curtain(const Fabric& fabric, std::uint32_t cells);

/// What becomes of x and y: the columns of a deformation of the plane z = 0.
struct Affine {
  Vec3 x{1, 0, 0}, y{0, 1, 0};
  Vec3 operator()(Vec3 p) const;
};

/// |f_u| - 1, |f_v| - 1 and the cosine of the angle between, of fabric that is deformed so.
std::array<double, 3> laws_of(const Fabric& fabric, const Affine& deformation);
/// The laws of each triangle at these positions; 0 where it has no such law, and of ropes that are
/// slack.
std::vector<std::array<double, 3>> fabric_laws(const SceneDescription& scene,
                                               const std::vector<Vec3>& positions);
/// J/m^2, likewise.
double energy_density(const Fabric& fabric, const Affine& deformation);
/// m^2
double area_of(const SceneDescription& scene);
/// J, of all triangles at these positions.
double fabric_energy(const SceneDescription& scene, const std::vector<Vec3>& positions);
/// N, against which the triangles pull a particle: the gradient of that energy, by differences.
Vec3 fabric_gradient(const SceneDescription& scene, std::vector<Vec3> positions,
                     std::uint32_t particle);

}  // namespace weft::test
