#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_mesh_bending {
namespace {

constexpr double kRadius = 40;  ///< of cylinders, in edges
constexpr int kDirections = 16;

/// The plane z = 0 rolled up, without stretching, around an axis across this direction.
Vec3 rolled(Vec3 p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = c * p.x + s * p.y, across = c * p.y - s * p.x;
  const double u = kRadius * std::sin(along / kRadius);
  return {c * u - s * across, s * u + c * across, kRadius * (1 - std::cos(along / kRadius))};
}

std::vector<Vec3> rolled(std::vector<Vec3> positions, double angle) {
  for (Vec3& p : positions) p = rolled(p, angle);
  return positions;
}

struct Range {
  double least = 1e300, most = -1e300;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

double cylinder_energy(const MeshDescription& mesh, double area) {
  return mesh.material->bending * area / (2 * kRadius * kRadius);
}

/// Particles that are more than two edges away from the border.
std::vector<bool> inner_particles(const MeshDescription& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  std::vector<std::vector<std::uint32_t>> faces;
  std::size_t first = 0;
  for (std::size_t left = mesh.corners.size(), f = 0; left > 0; left -= faces.back().size(), ++f) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    const auto begin = mesh.corners.begin() + static_cast<std::ptrdiff_t>(first);
    faces.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(size));
    first += size;
    for (std::size_t i = 0; i < size; ++i) {
      ++uses[std::minmax(faces.back()[i], faces.back()[(i + 1) % size])];
    }
  }
  std::vector<bool> inner(mesh.positions.size(), true);
  for (const auto& [ends, count] : uses) {
    if (count == 1) inner[ends.first] = inner[ends.second] = false;
  }
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<bool> within = inner;
    for (const auto& face : faces) {
      if (std::ranges::all_of(face, [&](std::uint32_t v) { return within[v]; })) continue;
      for (const std::uint32_t v : face) inner[v] = false;
    }
  }
  return inner;
}

/// The forces along z of bending elements that are flat at rest, on particles that may move.
std::vector<Vec3> bending_pull(const SceneDescription& scene, const std::vector<Vec3>& at,
                               const std::vector<bool>& moves) {
  std::vector<Vec3> pull(at.size());
  for (const BendingElement& e : scene.bending) {
    const std::size_t size = e.particles[3] == kNoIndex ? 3 : 4;
    double d = 0;
    for (std::size_t k = 0; k < size; ++k) d += e.weights[k] * at[e.particles[k]].z;
    for (std::size_t k = 0; k < size; ++k) {
      if (moves[e.particles[k]]) pull[e.particles[k]].z -= e.weights[k] / e.compliance * d;
    }
  }
  return pull;
}

double sum_of_products(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/// Where bending alone takes the particles that may move, along z: conjugate gradients.
std::vector<Vec3> settled(const SceneDescription& scene, std::vector<Vec3> at,
                          const std::vector<bool>& moves) {
  std::vector<Vec3> pull = bending_pull(scene, at, moves), way = pull;
  double size = sum_of_products(pull, pull);
  for (int i = 0; i < 200 && size > 0; ++i) {
    const std::vector<Vec3> change = bending_pull(scene, way, moves);
    const double step = -size / sum_of_products(way, change);
    for (std::size_t k = 0; k < at.size(); ++k) {
      at[k] = at[k] + step * way[k];
      pull[k] = pull[k] + step * change[k];
    }
    const double next = sum_of_products(pull, pull);
    for (std::size_t k = 0; k < at.size(); ++k) way[k] = pull[k] + (next / size) * way[k];
    size = next;
  }
  return at;
}

/// Over all directions: what is stored, of what a cylinder stores, when the particles within have
/// settled.
Range stiffness(MeshDescription mesh) {
  mesh.material = plain_material();
  const SceneDescription scene = made(mesh).scene;
  CHECK(build_model(scene));
  const double exact = cylinder_energy(mesh, area_of(scene, *mesh.material));
  const std::vector<bool> moves = inner_particles(mesh);
  Range range;
  for (int i = 0; i < kDirections; ++i) {
    const auto bent = rolled(scene.positions, std::numbers::pi * i / kDirections);
    range.add(bending_energy(scene, settled(scene, bent, moves)) / exact);
  }
  return range;
}

/// The same of parts of the sheet, all that is nearer than 2.6 edges to a particle. Each particle
/// has an equal part of an element.
Range local_stiffness(MeshDescription mesh) {
  mesh.material = plain_material();
  const SceneDescription scene = made(mesh).scene;
  Range range;
  for (int i = 0; i < kDirections; i += 2) {
    const auto bent = rolled(scene.positions, std::numbers::pi * i / kDirections);
    std::vector<double> energies(scene.positions.size(), 0);
    for (const BendingElement& element : scene.bending) {
      SceneDescription alone;
      alone.bending = {element};
      const double energy = bending_energy(alone, bent);
      const std::size_t size = element.particles[3] == kNoIndex ? 3 : 4;
      for (std::size_t k = 0; k < size; ++k) {
        energies[element.particles[k]] += energy / static_cast<double>(size);
      }
    }
    for (std::size_t v = 0; v < energies.size(); v += 7) {
      double energy = 0, area = 0;
      for (std::size_t w = 0; w < energies.size(); ++w) {
        const Vec3 p = scene.positions[v], q = scene.positions[w];
        if (std::hypot(p.x - q.x, p.y - q.y) > 2.6) continue;
        energy += energies[w];
        area += scene.masses[w] / mesh.material->density;
      }
      range.add(energy / cylinder_energy(mesh, area));
    }
  }
  return range;
}

void check_within(Range range, double error) {
  CHECK(range.least > 1 - error);
  CHECK(range.most < 1 + error);
}

MeshDescription moved(MeshDescription mesh, double jitter, Random& random) {
  for (Vec3& p : mesh.positions) {
    p.x += random.between(-jitter, jitter);
    p.y += random.between(-jitter, jitter);
  }
  return mesh;
}

MeshDescription cut_by_chance(std::uint32_t size, Random& random) {
  return sheet(
      size, size,
      [](double i, double j) {
        return Vec3{i, j, 0};
      },
      [&](auto, auto) { return random.below(2) == 0 ? Cut::first : Cut::second; });
}

MeshDescription parallelograms(double degrees, Cut cut) {
  const double angle = degrees * std::numbers::pi / 180;
  return sheet(
      16, 16,
      [&](double i, double j) {
        return Vec3{i + std::cos(angle) * j, std::sin(angle) * j, 0};
      },
      [&](auto, auto) { return cut; });
}

TEST_CASE("grids of rectangles store what a cylinder does, to the curvature's own error") {
  check_within(stiffness(quads(12)), 1e-3);
  MeshDescription oblong = quads(12);
  for (Vec3& p : oblong.positions) p.x *= 2;
  check_within(stiffness(oblong), 2e-3);
  MeshDescription uneven = quads(12);
  for (Vec3& p : uneven.positions) p.x += 0.03 * p.x * p.x;
  check_within(stiffness(uneven), 2e-3);
  check_within(stiffness(quads(3)), 1e-3);
}

TEST_CASE("right-angled triangles do, however the cells are cut") {
  Random random(1);
  check_within(stiffness(right_triangles(12)), 1e-3);
  check_within(stiffness(cut_by_chance(12, random)), 1e-3);
}

TEST_CASE("equilateral triangles are within two hundredths") {
  check_within(stiffness(equilateral_triangles(16)), 0.02);
}

TEST_CASE("irregular triangles are within five hundredths") {
  Random random(2);
  for (const double jitter : {0.1, 0.2, 0.3}) {
    CAPTURE(jitter);
    check_within(stiffness(irregular_triangles(16, jitter, random)), 0.05);
    check_within(stiffness(moved(cut_by_chance(20, random), jitter, random)), 0.05);
    check_within(stiffness(moved(right_triangles(20), jitter, random)), 0.05);
  }
}

TEST_CASE("lattices of other angles are within five hundredths, whichever way they are cut") {
  for (const double degrees : {50.0, 60.0, 70.0, 110.0}) {
    CAPTURE(degrees);
    check_within(stiffness(parallelograms(degrees, Cut::first)), 0.05);
    check_within(stiffness(parallelograms(degrees, Cut::second)), 0.05);
  }
}

TEST_CASE("quads that are not rectangles are within a tenth") {
  Random random(4);
  for (const double degrees : {60.0, 70.0, 80.0, 85.0, 88.0}) {
    CAPTURE(degrees);
    check_within(stiffness(parallelograms(degrees, Cut::none)), 0.1);
  }
  check_within(stiffness(moved(quads(16), 0.1, random)), 0.03);
  check_within(stiffness(moved(quads(16), 0.2, random)), 0.1);
}

TEST_CASE("quads beside triangles are within five hundredths") {
  Random random(6);
  MeshDescription mesh = sheet(
      20, 20,
      [&](double i, double j) {
        const double jitter = i < 10 ? 0 : 0.25;
        return Vec3{i + random.between(-jitter, jitter), j + random.between(-jitter, jitter), 0};
      },
      [&](std::uint32_t i, auto) {
        return i < 10 ? Cut::none : random.below(2) == 0 ? Cut::first : Cut::second;
      });
  check_within(stiffness(mesh), 0.05);
}

TEST_CASE("every part of a sheet is nearly as stiff as the whole") {
  Random random(7);
  check_within(local_stiffness(quads(14)), 0.05);
  check_within(local_stiffness(equilateral_triangles(14)), 0.15);
  check_within(local_stiffness(irregular_triangles(14, 0.25, random)), 0.25);
}

TEST_CASE("how many elements there are depends on the shape of the faces") {
  const auto elements = [](MeshDescription mesh) {
    mesh.material = plain_material();
    return static_cast<double>(made(mesh).scene.bending.size());
  };
  CHECK(elements(quads(20)) == 20 * 18 * 2 + 19 * 19);
  CHECK(elements(equilateral_triangles(20)) < 3.5 * 400);
  CHECK(elements(parallelograms(70, Cut::first)) < 6.5 * 256);
}

TEST_CASE("a flat mesh is flat at rest, when it lies askew and was rounded to floats too") {
  Random random(8);
  MeshDescription tilted = irregular_triangles(8, 0.25, random);
  tilted.material = plain_material();
  for (Vec3& p : tilted.positions) {
    const double x = p.x + 3, y = p.y - 2;
    p = {static_cast<float>(0.6 * x), static_cast<float>(0.8 * x), static_cast<float>(y)};
  }
  for (const BendingElement& element : made(tilted).scene.bending)
    CHECK((element.rest == 0 && element.fold == 0));
}

TEST_CASE("a mesh that is curved at rest stores nothing there, and as much when it is flat") {
  Random random(9);
  for (MeshDescription mesh : {quads(14), right_triangles(14), equilateral_triangles(14),
                               irregular_triangles(16, 0.2, random)}) {
    mesh.material = plain_material();
    const auto flat = mesh.positions;
    const auto particle_count = made(mesh).scene.positions.size();
    REQUIRE(particle_count == flat.size());
    for (const double angle : {0.0, 0.4, std::numbers::pi / 4}) {
      CAPTURE(angle);
      mesh.positions = rolled(flat, angle);
      const SceneDescription scene = made(mesh).scene;
      const double exact = cylinder_energy(mesh, area_of(scene, *mesh.material));
      CHECK(bending_energy(scene, scene.positions) < 1e-9 * exact);
      CHECK(bending_energy(scene, flat) == doctest::Approx(exact).epsilon(0.05));
    }
  }
}

TEST_CASE("weights are those of 1, -2, 1, whatever the size of the mesh") {
  for (const double size : {0.01, 1.0, 30.0}) {
    MeshDescription mesh = equilateral_triangles(5);
    for (Vec3& p : mesh.positions) p = {size * p.x, size * p.y, 0};
    mesh.material = plain_material();
    for (const BendingElement& element : made(mesh).scene.bending) {
      double sum = 0, sizes = 0;
      for (const double weight : element.weights) {
        sum += weight;
        sizes += std::abs(weight);
      }
      CHECK(sizes == doctest::Approx(4));
      CHECK(std::abs(sum) < 1e-12);
    }
  }
}

TEST_CASE("without bending stiffness there are no elements") {
  MeshDescription mesh = quads(4);
  mesh.material = plain_material();
  mesh.material->bending = 0;
  CHECK(made(mesh).scene.bending.empty());
}

}  // namespace
}  // namespace weft::test::engine_mesh_bending
