#include "tests/support/membrane.h"

#include <algorithm>
#include <cmath>

#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test {
namespace {

constexpr double kSide = 0.05;  // m

/// Over the corners where they are.
void add_triangle(SceneDescription& scene, const Fabric& fabric,
                  const std::array<std::uint32_t, 3>& corners) {
  MembraneElement element{.particles = corners,
                          .warp = fabric.warp,
                          .weft = fabric.weft,
                          .shear = fabric.shear,
                          .kind = fabric.kind};
  const double c = std::cos(fabric.angle), s = std::sin(fabric.angle);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 p = scene.positions[corners[k]];
    element.rest[k] = {c * p.x + s * p.y, c * p.y - s * p.x};
  }
  const Vec3 a = scene.positions[corners[0]];
  const Vec3 normal = cross(scene.positions[corners[1]] - a, scene.positions[corners[2]] - a);
  scene.masses.resize(scene.positions.size());
  for (const std::uint32_t i : corners) scene.masses[i] += fabric.density * length(normal) / 6;
  scene.membrane.push_back(element);
}

void add_cells(SceneDescription& scene, const Fabric& fabric, std::uint32_t cells, Random& random) {
  const std::uint32_t n = cells + 1;
  for (std::uint32_t row = 0; row < cells; ++row) {
    for (std::uint32_t column = 0; column < cells; ++column) {
      const std::uint32_t a = row * n + column, b = a + 1, c = a + n + 1, d = a + n;
      if (random.below(2) == 0) {
        add_triangle(scene, fabric, {a, b, c});
        add_triangle(scene, fabric, {a, c, d});
      } else {
        add_triangle(scene, fabric, {b, c, d});
        add_triangle(scene, fabric, {d, a, b});
      }
    }
  }
}

/// The columns of F along the warp and along the weft.
std::array<Vec3, 2> along_fabric(const MembraneElement& e, const std::vector<Vec3>& x) {
  const auto& [p0, p1, p2] = e.particles;
  const Vec3 d1 = x[p1] - x[p0], d2 = x[p2] - x[p0];
  const double u1 = e.rest[1][0] - e.rest[0][0], v1 = e.rest[1][1] - e.rest[0][1];
  const double u2 = e.rest[2][0] - e.rest[0][0], v2 = e.rest[2][1] - e.rest[0][1];
  const double over = 1 / (u1 * v2 - u2 * v1);
  return {over * (v2 * d1 - v1 * d2), over * (u1 * d2 - u2 * d1)};
}

std::array<double, 3> laws_of(Vec3 u, Vec3 v) {
  return {length(u) - 1, length(v) - 1, dot(u, v) / (length(u) * length(v))};
}

double density_of(const std::array<double, 3>& laws, const std::array<double, 3>& stiffness,
                  ConstraintKind kind) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_slack = kind == ConstraintKind::rope && k < 2 && laws[k] < 0;
    if (!is_slack) sum += 0.5 * stiffness[k] * laws[k] * laws[k];
  }
  return sum;
}

double area_of(const MembraneElement& e) {
  const auto& r = e.rest;
  return 0.5 * std::abs((r[1][0] - r[0][0]) * (r[2][1] - r[0][1]) -
                        (r[2][0] - r[0][0]) * (r[1][1] - r[0][1]));
}

}  // namespace

SceneDescription fabric_triangle(const Fabric& fabric) {
  SceneDescription scene;
  scene.positions = {{0.01, -0.02, 0}, {0.12, 0.01, 0}, {0.03, 0.09, 0}};
  scene.gravity = {};
  add_triangle(scene, fabric, {0, 1, 2});
  return scene;
}

SceneDescription fabric_patch(const Fabric& fabric, std::uint32_t cells, std::uint32_t seed) {
  SceneDescription scene;
  scene.gravity = {};
  Random random(seed);
  for (std::uint32_t row = 0; row <= cells; ++row) {
    for (std::uint32_t column = 0; column <= cells; ++column) {
      const bool is_inside = row > 0 && row < cells && column > 0 && column < cells;
      const Vec3 by = is_inside ? random.in_box(kSide / 3) : Vec3{};
      scene.positions.push_back({kSide * column + by.x, kSide * row + by.y, 0});
    }
  }
  add_cells(scene, fabric, cells, random);
  return scene;
}

std::vector<std::uint32_t> outline_of(std::uint32_t cells) {
  std::vector<std::uint32_t> outline;
  for (std::uint32_t row = 0; row <= cells; ++row) {
    for (std::uint32_t column = 0; column <= cells; ++column) {
      if (row == 0 || row == cells || column == 0 || column == cells)
        outline.push_back(row * (cells + 1) + column);
    }
  }
  return outline;
}

SceneDescription fabric_curtain(const Fabric& fabric, std::uint32_t cells) {
  SceneDescription scene;
  Random random(5);
  for (std::uint32_t row = 0; row <= cells; ++row) {
    for (std::uint32_t column = 0; column <= cells; ++column)
      scene.positions.push_back({kSide * column, -kSide * row, 0});
  }
  add_cells(scene, fabric, cells, random);
  for (std::uint32_t column = 0; column <= cells; ++column) scene.fixed.push_back(column);
  return scene;
}

Vec3 Affine::operator()(Vec3 p) const { return p.x * x + p.y * y + Vec3{0, 0, p.z}; }

std::array<double, 3> laws_of(const Fabric& fabric, const Affine& deformation) {
  const double c = std::cos(fabric.angle), s = std::sin(fabric.angle);
  return laws_of(c * deformation.x + s * deformation.y, c * deformation.y - s * deformation.x);
}

std::vector<std::array<double, 3>> fabric_laws(const SceneDescription& scene,
                                               const std::vector<Vec3>& positions) {
  std::vector<std::array<double, 3>> all;
  for (const MembraneElement& e : scene.membrane) {
    const auto [u, v] = along_fabric(e, positions);
    std::array<double, 3>& laws = all.emplace_back(laws_of(u, v));
    for (const std::size_t k : {0u, 1u})
      if (e.kind == ConstraintKind::rope) laws[k] = std::max(laws[k], 0.);
    if (e.warp == 0) laws[0] = 0;
    if (e.weft == 0) laws[1] = 0;
    if (e.shear == 0) laws[2] = 0;
  }
  return all;
}

double energy_density(const Fabric& fabric, const Affine& deformation) {
  return density_of(laws_of(fabric, deformation), {fabric.warp, fabric.weft, fabric.shear},
                    fabric.kind);
}

double area_of(const SceneDescription& scene) {
  double sum = 0;
  for (const MembraneElement& e : scene.membrane) sum += area_of(e);
  return sum;
}

double fabric_energy(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  double sum = 0;
  for (const MembraneElement& e : scene.membrane) {
    const auto [u, v] = along_fabric(e, positions);
    sum += area_of(e) * density_of(laws_of(u, v), {e.warp, e.weft, e.shear}, e.kind);
  }
  return sum;
}

Vec3 fabric_gradient(const SceneDescription& scene, std::vector<Vec3> positions,
                     std::uint32_t particle) {
  constexpr double kStep = 1e-6;  // m
  const auto along = [&](double Vec3::*axis) {
    double& place = positions[particle].*axis;
    const double at = place;
    place = at + kStep;
    const double above = fabric_energy(scene, positions);
    place = at - kStep;
    const double below = fabric_energy(scene, positions);
    place = at;
    return (above - below) / (2 * kStep);
  };
  return {along(&Vec3::x), along(&Vec3::y), along(&Vec3::z)};
}

}  // namespace weft::test
