#include "tests/support/sheets.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/membrane.h"
#include "tests/support/vectors.h"

namespace weft::test {
MeshDescription sheet(std::uint32_t rows, std::uint32_t columns,
                      const std::function<Vec3(double row, double column)>& place,
                      const std::function<Cut(std::uint32_t row, std::uint32_t column)>& cut) {
  MeshDescription mesh;
  const auto add = [&](std::initializer_list<std::uint32_t> corners) {
    mesh.corners.insert(mesh.corners.end(), corners);
    mesh.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  };
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) mesh.positions.push_back(place(i, j));
  }
  for (std::uint32_t i = 0; i + 1 < rows; ++i) {
    for (std::uint32_t j = 0; j + 1 < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = a + columns, c = b + 1, d = a + 1;
      switch (cut(i, j)) {
        case Cut::none:
          add({a, b, c, d});
          break;
        case Cut::first:
          add({a, b, c});
          add({a, c, d});
          break;
        case Cut::second:
          add({a, b, d});
          add({b, c, d});
          break;
      }
    }
  }
  return mesh;
}

MeshDescription quads(std::uint32_t size) {
  return sheet(
      size, size,
      [](double i, double j) {
        return Vec3{i, j, 0};
      },
      [](auto, auto) { return Cut::none; });
}

MeshDescription right_triangles(std::uint32_t size) {
  return sheet(
      size, size,
      [](double i, double j) {
        return Vec3{i, j, 0};
      },
      [](auto, auto) { return Cut::first; });
}

MeshDescription equilateral_triangles(std::uint32_t size) {
  return sheet(
      size, size,
      [](double i, double j) {
        return Vec3{i + std::fmod(j, 2) / 2, j * std::numbers::sqrt3 / 2, 0};
      },
      [](auto, std::uint32_t j) { return j % 2 == 0 ? Cut::second : Cut::first; });
}

MeshDescription irregular_triangles(std::uint32_t size, double jitter, Random& random) {
  MeshDescription mesh = equilateral_triangles(size);
  for (Vec3& p : mesh.positions) {
    p.x += random.between(-jitter, jitter);
    p.y += random.between(-jitter, jitter);
  }
  return mesh;
}

Material plain_material() {
  return {.density = 0.1, .warp = 1000, .weft = 600, .shear = 50, .bending = 2e-5};
}

MeshCloth made(const MeshDescription& mesh) {
  auto cloth = cloth_from_mesh(mesh);
  REQUIRE_MESSAGE(cloth, cloth.error());
  return std::move(cloth.value());
}

std::string refusal(const MeshDescription& mesh) {
  const auto cloth = cloth_from_mesh(mesh);
  REQUIRE_FALSE(cloth);
  return cloth.error();
}

double membrane_energy(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  double energy = 0;
  for (const Constraint& c : scene.constraints) {
    const double longer = distance(positions[c.a], positions[c.b]) - c.rest_length;
    energy += longer * longer / (2 * c.compliance);
  }
  return energy + fabric_energy(scene, positions);
}

/// The normal of a hinge that is folded at rest (scene.h).
Vec3 normal_of(const BendingElement& b, const std::vector<Vec3>& x) {
  const auto at = [&](std::size_t k) { return x[b.particles[k]]; };
  const Vec3 n =
      cross(at(1) - at(0), b.weights[3] * (at(3) - at(0)) - b.weights[2] * (at(2) - at(0)));
  return (1 / length(n)) * n;
}

double bending_energy(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  double energy = 0;
  for (const BendingElement& b : scene.bending) {
    Vec3 d;
    for (std::size_t i = 0; i < 4; ++i) {
      if (b.particles[i] == kNoIndex) continue;
      const Vec3 p = positions[b.particles[i]];
      d = {d.x + b.weights[i] * p.x, d.y + b.weights[i] * p.y, d.z + b.weights[i] * p.z};
    }
    if (b.fold != 0) d = d - b.fold * normal_of(b, positions);
    const double more = distance(d, {}) - b.rest;
    energy += more * more / (2 * b.compliance);
  }
  return energy;
}

double area_of(const SceneDescription& scene, const Material& material) {
  double mass = 0;
  for (const double m : scene.masses) mass += m;
  return mass / material.density;
}

}  // namespace weft::test
