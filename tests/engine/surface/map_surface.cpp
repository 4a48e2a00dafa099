/// A mesh that follows another: what a renderer draws on a coarse cloth, and levels of detail.
#include <doctest/doctest.h>
#include <weft/surface.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/surface/nearest_triangle.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_surface_map_surface {
namespace {

using std::numbers::pi;
using Place = std::function<Vec3(Vec3)>;

struct Read {
  std::vector<Vec3> places, normals;
};
Read read(Surface& surface, const Cloth& cloth) {
  std::vector<float> floats(6 * surface.vertex_count());
  REQUIRE(surface.read_vertices(cloth, {floats, 6}, {std::span(floats).subspan(3), 6}));
  Read result;
  for (std::size_t i = 0; i < floats.size(); i += 6) {
    result.places.push_back({floats[i], floats[i + 1], floats[i + 2]});
    result.normals.push_back({floats[i + 3], floats[i + 4], floats[i + 5]});
  }
  return result;
}

/// A coarse cloth and a fine mesh that follows it.
struct Mapped {
  MeshDescription mesh, fine;
  MeshCloth made;
  Cloth cloth;
  Surface surface;

  Mapped(const MeshDescription& coarse, const MeshDescription& other)
      : mesh(coarse),
        fine(other),
        made(cloth_from_mesh(mesh).value()),
        cloth(cloth_of(made.scene, {})),
        surface(map_surface(mesh, made, fine).value()) {}

  Read put(const Place& place) {
    std::vector<Vec3> places = made.scene.positions;
    for (Vec3& p : places) p = place(p);
    REQUIRE(cloth.write_positions(places));
    return read(surface, cloth);
  }
};

/// The unit square, in `cells` squares a side, placed.
MeshDescription square(std::uint32_t cells, Cut cut, const Place& place) {
  return sheet(
      cells + 1, cells + 1,
      [&](double i, double j) {
        return place({i / cells, j / cells, 0});
      },
      [=](auto, auto) { return cut; });
}

Vec3 bowl(Vec3 p) {
  const double x = p.x - 0.5, y = p.y - 0.5;
  return {p.x, p.y, 0.5 * (x * x - y * y) + 0.1 * std::sin(5 * p.x)};
}

/// A fine mesh around the bowl: larger than it, and at distances of up to 20 mm.
MeshDescription around_bowl() {
  return square(23, Cut::second, [](Vec3 p) {
    const Vec3 at = bowl({1.1 * p.x - 0.05, 1.1 * p.y - 0.05, 0});
    return at + Vec3{0, 0, 0.02 * std::sin(9 * p.x + 7 * p.y)};
  });
}

Vec3 turned(Vec3 p) {  // by a quarter about y, then moved
  return Vec3{p.z, p.y, -p.x} + Vec3{3, -5, 2};
}

TEST_CASE("at the beginning, and after rigid motions, the other mesh lies as it was described") {
  Mapped mapped(square(7, Cut::none, bowl), around_bowl());
  const Read start = mapped.put([](Vec3 p) { return p; });
  const Read moved = mapped.put(turned);
  for (std::size_t v = 0; v < mapped.fine.positions.size(); ++v) {
    CHECK(distance(start.places[v], mapped.fine.positions[v]) < 1e-6);
    CHECK(distance(moved.places[v], turned(mapped.fine.positions[v])) < 2e-6);
    CHECK(distance(moved.normals[v], turned(start.normals[v]) - turned({})) < 1e-4);
  }
}

Place affine(Random& random) {
  const Vec3 x = Vec3{1, 0, 0} + random.in_box(0.8), y = Vec3{0, 1, 0} + random.in_box(0.8),
             z = Vec3{0, 0, 1} + random.in_box(0.8), to = random.in_box(10);
  return [=](Vec3 p) { return p.x * x + p.y * y + p.z * z + to; };
}

TEST_CASE("what lies in the planes of triangles follows every affine map") {
  Random random(11);
  const auto flat = [](Vec3 p) { return p; };
  for (int round = 0; round < 30; ++round) {
    const auto jittered = [&](Vec3 p) {
      const Vec3 by = random.in_box(0.04);
      return Vec3{p.x + by.x, p.y + by.y, 0};
    };
    // One that reaches beyond the border, and one on the planes of a bent sheet's triangles.
    Mapped beyond(square(5, Cut::first, jittered), square(11, Cut::none, [](Vec3 p) {
                    return Vec3{1.2 * p.x - 0.1, 1.2 * p.y - 0.1, 0};
                  }));
    MeshDescription bent = square(4, Cut::first, bowl), on_bent;
    for (std::size_t f = 0; f < bent.corners.size(); f += 3) {
      const Vec3 a = bent.positions[bent.corners[f]], b = bent.positions[bent.corners[f + 1]],
                 c = bent.positions[bent.corners[f + 2]];
      for (const Vec3& shares : {Vec3{0.6, 0.3, 0.1}, Vec3{0.1, 0.6, 0.3}, Vec3{0.2, 0.1, 0.7}}) {
        on_bent.corners.push_back(static_cast<std::uint32_t>(on_bent.positions.size()));
        on_bent.positions.push_back(shares.x * a + shares.y * b + shares.z * c);
      }
    }
    Mapped within(bent, on_bent);
    for (Mapped* each : {&beyond, &within}) {
      const Place map = affine(random);
      const Read found = each->put(map);
      for (std::size_t v = 0; v < found.places.size(); ++v)
        CHECK(distance(found.places[v], map(each->fine.positions[v])) < 3e-6);
    }
  }
  Mapped same(square(5, Cut::none, flat), square(10, Cut::none, flat));
  const Read found = same.put([](Vec3 p) { return Vec3{2 * p.x, p.y + 0.5 * p.x, 0}; });
  for (const Vec3& normal : found.normals) CHECK(distance(normal, {0, 0, 1}) < 1e-5);
}

TEST_CASE("what lies at a distance keeps it, however the cloth stretches and bends") {
  const double height = 0.05, radius = 0.4;
  const auto flat = [](Vec3 p) { return p; };
  Mapped mapped(square(12, Cut::none, flat), square(31, Cut::first, [&](Vec3 p) {
                  return Vec3{p.x, p.y, height};
                }));
  for (const Vec3& p : mapped.put([](Vec3 q) { return Vec3{2 * q.x, 0.5 * q.y, 0}; }).places)
    CHECK(p.z == doctest::Approx(height));
  // On a cylinder within the arrows of its chords, and without steps where triangles meet. At the
  // border of the cloth its normal leans by half the angle of a cell.
  const double lean = std::cos(1 / 12. / radius);
  const double arrow = radius * (1 - std::cos(1 / 24. / radius));
  const Read bent = mapped.put([&](Vec3 p) {
    return Vec3{radius * std::sin(p.x / radius), p.y, radius * (1 - std::cos(p.x / radius))};
  });
  for (std::size_t v = 0; v < bent.places.size(); ++v) {
    const Vec3 p = bent.places[v];
    const double off = radius - std::hypot(p.x, p.z - radius);
    CHECK(off > height * lean);
    CHECK(off < height + arrow + 1e-3);
    if (v % 32 == 0 || v / 32 == 0) continue;
    const double edge = distance(p, bent.places[v - 32]);
    CHECK(edge == doctest::Approx((1 - height / radius) / 31).epsilon(0.06));
  }
}

TEST_CASE("a sharp fold of the mesh is followed too") {
  MeshDescription folded;  // two layers, joined along x = 0
  folded.positions = {{0, 0, 0},    {0, 1, 0},     {1, 1, 0.01},
                      {1, 0, 0.01}, {1, 1, -0.01}, {1, 0, -0.01}};
  folded.corners = {0, 1, 2, 3, 0, 5, 4, 1};
  folded.face_sizes = {4, 4};
  MeshDescription other = quads(4);
  for (Vec3& p : other.positions) p = Vec3{0.3 * p.x - 0.1, 0.3 * p.y, 0.02};
  Mapped mapped(folded, other);
  const Read moved = mapped.put(turned);
  for (std::size_t v = 0; v < other.positions.size(); ++v)
    CHECK(distance(moved.places[v], turned(other.positions[v])) < 3e-6);
}

TEST_CASE("the nearest triangle is the nearest of all") {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points;
    std::vector<surface::Triangle> triangles;
    for (std::uint32_t i = 0; i < 40; ++i) points.push_back(random.in_box(1));
    for (std::uint32_t i = 0; i < 60; ++i) {
      const std::uint32_t a = random.below(40);
      triangles.push_back({a, (a + 1 + random.below(10)) % 40, (a + 11 + random.below(10)) % 40});
    }
    triangles.push_back({7, 7, 8});
    const surface::NearestTriangle tree(points, triangles);
    for (int k = 0; k < 50; ++k) {
      const Vec3 place = random.in_box(1.5);
      double least = 1e9;
      for (std::size_t t = 0; t + 1 < triangles.size(); ++t) {
        const surface::NearestTriangle alone(points, std::span(triangles).subspan(t, 1));
        least = std::min(least, alone(place).distance);
      }
      const surface::Nearest found = tree(place);
      CHECK(found.distance == doctest::Approx(least));
      const auto [a, b, c] = triangles[found.triangle];
      const Vec3 at =
          found.shares[0] * points[a] + found.shares[1] * points[b] + found.shares[2] * points[c];
      CHECK(distance(at, place) == doctest::Approx(least));
      // No place of a fine net over the triangle is nearer.
      for (int i = 0; i <= 20; ++i) {
        for (int j = 0; i + j <= 20; ++j) {
          const Vec3 p =
              (i / 20.) * points[a] + (j / 20.) * points[b] + (1 - (i + j) / 20.) * points[c];
          CHECK(distance(p, place) > least - 1e-9);
        }
      }
    }
  }
}

TEST_CASE("velocities of another level of detail are those of the motion of its points") {
  const MeshDescription coarse = square(6, Cut::none, bowl), fine = around_bowl();
  Mapped mapped(coarse, fine);
  Cloth to = cloth_of(cloth_from_mesh(fine).value().scene, {});
  const Vec3 spin{1, -2, 0.5}, speed{0.3, 0.2, -1};
  std::vector<Vec3> rates;
  for (const Vec3& p : mapped.made.scene.positions) rates.push_back(speed + cross(spin, p));
  REQUIRE(mapped.cloth.write_velocities(rates));
  REQUIRE(mapped.surface.copy_shape(mapped.cloth, to));
  for (std::uint32_t i = 0; i < to.particle_count(); ++i) {
    CHECK(distance(to.position(i), fine.positions[i]) < 1e-6);
    CHECK(distance(to.velocity(i), speed + cross(spin, fine.positions[i])) < 1e-5);
  }
  // In the plane, of every linear field.
  Mapped plane(square(5, Cut::first, [](Vec3 p) { return p; }),
               square(9, Cut::none, [](Vec3 p) { return p; }));
  Random random(2);
  const Place field = affine(random);
  rates.clear();
  for (const Vec3& p : plane.made.scene.positions) rates.push_back(field(p));
  REQUIRE(plane.cloth.write_velocities(rates));
  Cloth flat = cloth_of(cloth_from_mesh(plane.fine).value().scene, {});
  REQUIRE(plane.surface.copy_shape(plane.cloth, flat));
  for (std::uint32_t i = 0; i < flat.particle_count(); ++i)
    CHECK(distance(flat.velocity(i), field(plane.fine.positions[i])) < 1e-5);
}

TEST_CASE("a level of detail goes on as the other did") {
  const auto hung = [](std::uint32_t cells) {
    MeshDescription mesh = square(cells, Cut::none, [](Vec3 p) { return Vec3{p.x, 0, p.y}; });
    for (std::uint32_t j = 0; j <= cells; ++j) mesh.pins.push_back(j);
    mesh.material = find_material("cotton").value();
    return mesh;
  };
  const MeshDescription coarse = hung(10), fine = hung(21);
  const MeshCloth coarse_made = made(coarse), fine_made = made(fine);
  Cloth near = cloth_of(fine_made.scene, {}), far = cloth_of(coarse_made.scene, {});
  run(near, 1. / 60, 20);
  run(far, 1. / 60, 20);
  Cloth taken = cloth_of(fine_made.scene, {});
  Surface surface = map_surface(coarse, coarse_made, fine).value();
  REQUIRE(surface.copy_shape(far, taken));
  CHECK(taken.energy().kinetic == doctest::Approx(near.energy().kinetic).epsilon(0.05));
  run(near, 1. / 60, 10);
  for (int k = 0; k < 10; ++k) CHECK(step(taken, 1. / 60).status == Status::converged);
  CHECK(largest_distance(positions(taken), positions(near)) < 0.05);
}

TEST_CASE("vertices at one place are one point; what is in no face stays") {
  MeshDescription fine = quads(5);
  for (Vec3& p : fine.positions) p = 0.25 * p;
  fine.positions.push_back(fine.positions[0]);
  fine.positions.push_back({0.3, 0.3, 0.3});
  fine.positions.push_back({0.9, 0.1, 0});
  fine.corners.insert(fine.corners.end(), {25, 1, 27});
  fine.face_sizes.push_back(3);
  Mapped mapped(square(3, Cut::none, [](Vec3 p) { return p; }), fine);
  std::vector<float> floats(3 * 28, -7);
  REQUIRE(mapped.surface.read_vertices(mapped.cloth, {}, {floats}));
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    CHECK(floats[i] == floats[75 + i]);
    CHECK(floats[78 + i] == -7);
  }
}

TEST_CASE("what cannot be mapped is refused with one line, and nothing changes") {
  const auto flat = [](Vec3 p) { return p; };
  const MeshDescription mesh = square(4, Cut::none, flat);
  const MeshCloth cloth = made(mesh);
  MeshDescription other = square(8, Cut::none, flat);
  other.positions[13].z = 0.25;
  const auto refusal_of = [&](const MeshDescription& from, const MeshDescription& to, double most) {
    const auto r = map_surface(from, made(from), to, most);
    return r ? std::string() : r.error();
  };
  CHECK(refusal_of(mesh, other, 0.26).empty());
  CHECK(refusal_of(mesh, other, 0.2) ==
        "other.positions[13]: is farther from the mesh than max_distance, 0.2 (0.25)");
  CHECK(refusal_of(mesh, other, std::nan("")) == "max_distance: must be at least 0 (nan)");
  CHECK(refusal_of(mesh, other, -1) == "max_distance: must be at least 0 (-1)");
  MeshDescription thread;
  thread.positions = {{0, 0, 0}, {1, 0, 0}};
  thread.lines = {{0, 1}};
  CHECK(refusal_of(thread, other, 1) == "mesh: has no face with an area");
  other.positions[2].y = std::nan("");
  CHECK(refusal_of(mesh, other, 1).starts_with("other.positions[2]: must be finite"));
  CHECK(map_surface(other, cloth, mesh).error().starts_with("positions[2]: must be finite"));

  Surface surface = map_surface(mesh, cloth, square(8, Cut::none, flat)).value();
  Surface direct = surface_of_mesh(mesh, cloth).value();
  Cloth from = cloth_of(cloth.scene, {}), to = cloth_of(scene_of("hang", 9), {});
  Cloth wrong = cloth_of(scene_of("hang", 8), {});
  const std::uint64_t before = wrong.state_hash(), target = to.state_hash();
  CHECK(surface.copy_shape(from, wrong).error() == "to: needs 81 elements (64)");
  CHECK(wrong.state_hash() == before);
  CHECK(surface.copy_shape(wrong, to).error() == "from: needs 25 elements (64)");
  CHECK(direct.copy_shape(from, to).error() ==
        "copy_shape: this surface was not made by map_surface");
  CHECK(to.state_hash() == target);
  CHECK(surface.copy_shape(from, to));
}

}  // namespace
}  // namespace weft::test::engine_surface_map_surface
