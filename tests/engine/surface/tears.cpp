/// What a renderer draws of cloth that tears, and meshes that follow it.
#include <doctest/doctest.h>
#include <weft/surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "engine/partition.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_surface_tears {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double kLength = 0.4, kWidth = 0.2;  // m

/// A strip along x with a waist, pinned at both ends.
MeshDescription strip(std::uint32_t cells, Cut cut, double jitter) {
  const auto place = [=](double row, double column) {
    const double u = row / (2 * cells), v = column / cells - 0.5;
    const bool is_inner = row > 0 && row < 2 * cells && column > 0 && column < cells;
    const double by = is_inner ? jitter / cells * std::sin(12.9 * row + 78.2 * column) : 0;
    const double waist = 1 - 0.4 * std::sin(std::numbers::pi * u);
    return Vec3{kLength * (u + by), kWidth * waist * (v + by), 0};
  };
  return sheet(2 * cells + 1, cells + 1, place, [=](std::uint32_t i, std::uint32_t j) {
    return cut != Cut::none && (i + j) % 2 == 1 ? Cut::second : cut;
  });
}

/// It is torn by its ends.
struct Torn {
  MeshDescription mesh;
  MeshCloth made;
  Cloth cloth;
  Surface surface;
  double stretch = 0;

  explicit Torn(MeshDescription of)
      : mesh(with_material(std::move(of))),
        made(cloth_from_mesh(mesh).value()),
        cloth(cloth_of(scene(), {})),
        surface(surface_of_mesh(mesh, made).value()) {}

  static MeshDescription with_material(MeshDescription mesh) {
    mesh.material = {.density = 0.5,
                     .warp = 200,
                     .weft = 200,
                     .shear = 40,
                     .bending = 1e-6,
                     .damping_motion = 3};
    mesh.material->strength = 20;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
      if (mesh.positions[v].x == 0 || mesh.positions[v].x == kLength) mesh.pins.push_back(v);
    return mesh;
  }
  SceneDescription scene() {
    made.scene.gravity = {0, 0, 0};
    return made.scene;
  }
  /// Returns whether anything broke.
  bool pull() {
    stretch += 5e-3;
    for (const std::uint32_t pin : mesh.pins) {
      const Vec3 x = mesh.positions[pin];
      if (x.x > 0)
        REQUIRE(cloth.move_fixed(made.particle_of_vertex[pin],
                                 {x.x * (1 + stretch), x.y, 0.2 * x.x * stretch}));
    }
    const auto report = cloth.step(1.0 / 60);
    REQUIRE(report);
    return report.value().torn > 0;
  }
};

struct Read {
  std::vector<Vec3> places, normals;
};
Read read(Surface& surface, const Cloth& cloth) {
  std::vector<float> floats(6 * surface.vertex_count());
  const auto r = surface.read_vertices(cloth, {floats, 6}, {std::span(floats).subspan(3), 6});
  REQUIRE_MESSAGE(r, r.error());
  Read result;
  for (std::size_t i = 0; i < floats.size(); i += 6) {
    result.places.push_back({floats[i], floats[i + 1], floats[i + 2]});
    result.normals.push_back({floats[i + 3], floats[i + 4], floats[i + 5]});
  }
  return result;
}

using Places = std::multiset<std::array<std::array<float, 3>, 3>>;
template <class PlaceOf>
Places places_of(std::span<const Triangle> triangles, const PlaceOf& place_of) {
  Places places;
  for (const Triangle& t : triangles) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = place_of(t[k]);
      corners[k] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    places.insert(corners);
  }
  return places;
}

/// Pieces of triangles that have `shared` corners in common: 1, a vertex, or 2, a side.
std::size_t pieces(const Surface& surface, std::size_t shared = 1) {
  const auto triangles = surface.triangles();
  Partition joined(triangles.size());
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> first_at;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k], b = shared == 1 ? a : triangles[t][(k + 1) % 3];
      joined.join(first_at.try_emplace({std::min(a, b), std::max(a, b)}, t).first->second, t);
    }
  }
  std::set<std::uint32_t> firsts;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) firsts.insert(joined.first(t));
  return firsts.size();
}

struct Kind {
  Cut cut;
  double jitter;
};
constexpr Kind kKinds[] = {{Cut::none, 0}, {Cut::first, 0}, {Cut::first, 0.3}};

TEST_CASE("a surface draws the triangles of a cloth as tears leave them, and its own vertices") {
  for (const auto& [cut, jitter] : kKinds) {
    CAPTURE(jitter);
    Torn torn(strip(8, cut, jitter));
    const auto& mesh = torn.mesh;
    const std::size_t vertices = mesh.positions.size();
    int tears = 0;
    while (torn.stretch < 1.2) {
      const bool is_torn = torn.pull();
      const auto follows = torn.surface.follow(torn.cloth);
      REQUIRE_MESSAGE(follows, follows.error());
      CHECK(follows.value() == is_torn);
      tears += is_torn;
      if (!is_torn && torn.stretch < 1.19) continue;
      const Read seen = read(torn.surface, torn.cloth);
      CHECK(
          places_of(torn.surface.triangles(), [&](std::uint32_t v) { return seen.places[v]; }) ==
          places_of(torn.cloth.surface(), [&](std::uint32_t p) { return torn.cloth.position(p); }));
      const auto split_from = torn.surface.split_from();
      REQUIRE(torn.surface.vertex_count() == vertices + split_from.size());
      CHECK(std::ranges::all_of(split_from, [&](std::uint32_t v) { return v < vertices; }));
      const auto source = [&](std::uint32_t v) {
        return v < vertices ? v : split_from[v - vertices];
      };
      Places drawn = places_of(torn.surface.triangles(),
                               [&](std::uint32_t v) { return mesh.positions[source(v)]; });
      CHECK(drawn == places_of(torn.made.scene.surface,
                               [&](std::uint32_t p) { return torn.made.scene.positions[p]; }));
    }
    CHECK(tears > 4);
    CHECK(pieces(torn.surface) >= 2);
    // A clone goes on by itself; the cloth before has the surface that was made of it.
    Surface copy = torn.surface.clone();
    const Read seen = read(torn.surface, torn.cloth);
    CHECK(largest_distance(read(copy, torn.cloth).normals, seen.normals) == 0);
    const Cloth before = cloth_of(torn.scene(), {});
    CHECK(torn.surface.follow(before).value());
    CHECK(torn.surface.vertex_count() == vertices);
    Surface fresh = surface_of_mesh(mesh, torn.made).value();
    CHECK(largest_distance(read(torn.surface, before).normals, read(fresh, before).normals) == 0);
    CHECK(std::ranges::equal(torn.surface.triangles(), fresh.triangles()));
    CHECK(torn.surface.follow(torn.cloth).value());
    CHECK(largest_distance(read(torn.surface, torn.cloth).normals, seen.normals) == 0);
  }
}

TEST_CASE("both sides of a mesh are torn, each with its normals, and so is one of two textures") {
  MeshDescription mesh = strip(6, Cut::none, 0);
  const auto front = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t v = 0; v < front; ++v) mesh.positions.push_back(mesh.positions[v]);
  const std::vector<std::uint32_t> corners = mesh.corners;
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    for (const std::size_t k : {3u, 2u, 1u, 0u}) mesh.corners.push_back(front + corners[i + k]);
  }
  mesh.face_sizes.insert(mesh.face_sizes.end(), corners.size() / 4, 4);
  Torn torn(mesh);
  while (torn.stretch < 1.2) torn.pull();
  REQUIRE(torn.surface.follow(torn.cloth).value());
  CHECK(torn.surface.split_from().size() % 2 == 0);
  const Read seen = read(torn.surface, torn.cloth);
  const auto triangles = torn.surface.triangles();
  REQUIRE(triangles.size() == 2 * torn.cloth.surface().size());
  const auto front_places = places_of(triangles.first(triangles.size() / 2),
                                      [&](std::uint32_t v) { return seen.places[v]; });
  std::vector<Triangle> turned;
  for (const auto& [a, b, c] : triangles.subspan(triangles.size() / 2)) turned.push_back({a, c, b});
  CHECK(places_of(turned, [&](std::uint32_t v) { return seen.places[v]; }) == front_places);
  for (std::uint32_t v = 0; v < front; ++v)
    CHECK(length(seen.normals[v] + seen.normals[front + v]) == 0);
  const auto split_from = torn.surface.split_from();
  for (std::size_t i = 0; i < split_from.size(); i += 2) {
    REQUIRE(split_from[i] + front == split_from[i + 1]);
    CHECK(length(seen.normals[2 * front + i] + seen.normals[2 * front + i + 1]) == 0);
  }
}

/// The largest of its sides over those at the beginning.
double largest_stretch(const Surface& surface, const MeshDescription& mesh,
                       const std::vector<Vec3>& places) {
  const std::size_t vertices = mesh.positions.size();
  double largest = 0;
  for (const Triangle& t : surface.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const auto source = [&](std::uint32_t v) {
        return mesh.positions[v < vertices ? v : surface.split_from()[v - vertices]];
      };
      largest = std::max(largest, distance(places[a], places[b]) / distance(source(a), source(b)));
    }
  }
  return largest;
}

TEST_CASE(
    "a mesh that follows splits along its own edges beside the tear, and nothing else of it") {
  for (const auto& [cut, jitter] : kKinds) {
    for (const std::uint32_t cells : {5u, 8u, 13u, 24u}) {
      CAPTURE(jitter);
      CAPTURE(cells);
      Torn torn(strip(8, cut, jitter));
      const MeshDescription fine = strip(cells, Cut::none, 0);
      Surface mapped = map_surface(torn.mesh, torn.made, fine).value();
      const std::size_t triangles = mapped.triangles().size();
      while (torn.stretch < 1.2) {
        const bool is_torn = torn.pull();
        REQUIRE(mapped.follow(torn.cloth).value() == is_torn);
        REQUIRE(torn.surface.follow(torn.cloth));
        const Read seen = read(mapped, torn.cloth);
        const Read coarse = read(torn.surface, torn.cloth);
        // No triangle of it spans the tear, which is as wide as ten of them in the end. Those
        // beside it are stretched as the cloth is, where they reach over its border a little more.
        CHECK(largest_stretch(mapped, fine, seen.places) <
              2 * largest_stretch(torn.surface, torn.mesh, coarse.places));
      }
      CHECK(mapped.triangles().size() == triangles);
      CHECK(pieces(mapped) >= 2);
      // A triangle that hangs on one particle of the cloth is a piece of its own in it.
      CHECK(pieces(mapped) <= pieces(torn.surface, 2));
    }
  }
}

TEST_CASE("what has torn otherwise is refused until it is followed") {
  Torn torn(strip(6, Cut::none, 0));
  Surface mapped = map_surface(torn.mesh, torn.made, strip(9, Cut::none, 0)).value();
  Cloth to = cloth_of(cloth_from_mesh(strip(9, Cut::none, 0)).value().scene, {});
  while (!torn.pull()) continue;
  std::vector<float> floats(3 * torn.surface.vertex_count(), -7);
  const std::string line = "from: has torn, so follow() comes first; its particles (" +
                           std::to_string(torn.cloth.particle_count()) + ")";
  CHECK(torn.surface.read_vertices(torn.cloth, {floats}).error() == line);
  CHECK(mapped.copy_shape(torn.cloth, to).error() == line);
  REQUIRE(torn.surface.follow(torn.cloth).value());
  REQUIRE(mapped.follow(torn.cloth).value());
  CHECK(mapped.copy_shape(torn.cloth, to).error() == "copy_shape: the cloth that is read has torn");
  CHECK(torn.surface.read_vertices(torn.cloth, {floats}).error().starts_with("positions: needs"));
  CHECK(std::ranges::all_of(floats, [](float f) { return f == -7; }));
  CHECK_FALSE(torn.surface.follow(torn.cloth).value());
  CHECK_FALSE(mapped.follow(torn.cloth).value());
  floats.resize(3 * mapped.vertex_count());
  CHECK(mapped.read_vertices(torn.cloth, {floats}));
  floats.resize(3 * torn.surface.vertex_count());
  CHECK(torn.surface.read_vertices(torn.cloth, {floats}));
  // Changed, it is the same cloth; another one that has torn otherwise is not.
  REQUIRE(torn.cloth.change({.damping = Damping{.motion = 1}}));
  CHECK(torn.surface.read_vertices(torn.cloth, {floats}));
  CHECK_FALSE(torn.surface.follow(torn.cloth).value());
  SceneDescription scene = torn.scene();
  scene.constraints.front().strength = 1;
  auto other = cloth_of(scene, {});
  CHECK(torn.surface.read_vertices(other, {floats}).error().starts_with("from: needs"));
  CHECK(torn.surface.follow(other).value());
  MeshDescription plain = torn.mesh;
  plain.material->strength = std::numeric_limits<double>::infinity();
  Surface without = surface_of_mesh(plain, cloth_from_mesh(plain).value()).value();
  CHECK(without.follow(torn.cloth).error() ==
        "from: has torn, and nothing had a strength when the surface was made (" +
            std::to_string(torn.cloth.particle_count()) + ")");
}

}  // namespace
}  // namespace weft::test::engine_surface_tears
