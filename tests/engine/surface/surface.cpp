/// What a renderer reads of a mesh that is cloth: positions and normals by vertex.
#include <doctest/doctest.h>
#include <weft/surface.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_surface_surface {
namespace {

using std::numbers::pi;

Vec3 unit(Vec3 v) { return (1 / length(v)) * v; }

/// A mesh, the cloth that was made of it, and what is read of its surface.
struct Drawn {
  MeshDescription mesh;
  MeshCloth made;
  Cloth cloth;
  Surface surface;

  explicit Drawn(const MeshDescription& of)
      : mesh(of),
        made(cloth_from_mesh(mesh).value()),
        cloth(cloth_of(made.scene, {})),
        surface(surface_of_mesh(mesh, made).value()) {}

  std::vector<Vec3> read(bool are_normals, Vec3 origin = {}) {
    std::vector<float> floats(3 * mesh.positions.size(), -7);
    REQUIRE((are_normals ? surface.read_vertices(cloth, {}, {floats}, origin)
                         : surface.read_vertices(cloth, {floats}, {}, origin)));
    std::vector<Vec3> vectors;
    for (std::size_t i = 0; i < floats.size(); i += 3)
      vectors.push_back({floats[i], floats[i + 1], floats[i + 2]});
    return vectors;
  }
  std::vector<Vec3> normals() { return read(true); }
  std::vector<Vec3> vertices(Vec3 origin = {}) { return read(false, origin); }
  void put(const std::function<Vec3(Vec3)>& place) {
    std::vector<Vec3> places = made.scene.positions;
    for (Vec3& p : places) p = place(p);
    REQUIRE(cloth.write_positions(places));
  }
};

MeshDescription cut_sheet(std::uint32_t rows, std::uint32_t columns,
                          const std::function<Vec3(double, double)>& place, Cut cut) {
  return sheet(rows, columns, place, [=](auto, auto) { return cut; });
}

/// As much as normals that are found by floats may be off.
constexpr double kRounding = 3e-6;

TEST_CASE("in a plane every normal is that of the plane, whatever the faces") {
  const Vec3 u = unit({1, 2, -0.5}), v = unit(cross(u, {0, 0, 1})), normal = cross(u, v);
  Random random(1);
  for (const MeshDescription& mesh :
       {quads(7), right_triangles(7), irregular_triangles(7, 0.3, random)}) {
    Drawn drawn(mesh);
    drawn.put([&](Vec3 p) { return p.x * u + p.y * v; });
    for (const Vec3& n : drawn.normals()) CHECK(distance(n, normal) < kRounding);
  }
  MeshDescription hexagon;
  for (int i = 0; i < 6; ++i)
    hexagon.positions.push_back({std::cos(i * pi / 3), std::sin(i * pi / 3), 0});
  hexagon.corners = {0, 1, 2, 3, 4, 5};
  hexagon.face_sizes = {6};
  for (const Vec3& n : Drawn(hexagon).normals()) CHECK(distance(n, {0, 0, 1}) < kRounding);
}

TEST_CASE("normals of a cylinder are radial, across its welded seam too") {
  const std::uint32_t around = 24;
  for (const Cut cut : {Cut::none, Cut::first}) {
    const auto place = [&](double row, double column) {
      const double angle = column == around ? 0 : 2 * pi * column / around;
      return Vec3{std::cos(angle), 0.2 * row, std::sin(angle)};
    };
    Drawn drawn(cut_sheet(9, around + 1, place, cut));
    REQUIRE(drawn.made.counts.welded_vertices == 9);
    const std::vector<Vec3> normals = drawn.normals();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vec3 p = drawn.mesh.positions[i];
      const bool is_rim = i < around + 1 || i >= 8 * (around + 1);
      // Triangles cut along one diagonal lean to one side where a rim leaves some of them out.
      if (cut == Cut::none || !is_rim) CHECK(distance(normals[i], {p.x, 0, p.z}) < kRounding);
      if (i % (around + 1) == 0) CHECK(distance(normals[i], normals[i + around]) == 0);
    }
  }
}

/// The largest angle between normals and radii of a sphere, not at the border of the sheet.
double error_on_sphere(std::uint32_t size, Cut cut) {
  const auto place = [&](double row, double column) {
    const double polar = pi / 4 + pi / 2 * row / (size - 1);
    const double around = pi / 2 * column / (size - 1);
    return Vec3{std::sin(polar) * std::cos(around), std::cos(polar),
                std::sin(polar) * std::sin(around)};
  };
  Drawn drawn(cut_sheet(size, size, place, cut));
  const std::vector<Vec3> normals = drawn.normals();
  double worst = 0;
  for (std::uint32_t i = 1; i + 1 < size; ++i) {
    for (std::uint32_t j = 1; j + 1 < size; ++j) {
      const Vec3 radius = drawn.mesh.positions[i * size + j];
      worst = std::max(worst, std::asin(length(cross(normals[i * size + j], radius))));
    }
  }
  return worst;
}

TEST_CASE("normals of a sphere are second order in the length of edges") {
  for (const Cut cut : {Cut::none, Cut::first}) {
    const double coarse = error_on_sphere(9, cut), fine = error_on_sphere(17, cut);
    const double edge = pi / 2 / 16;
    CAPTURE(coarse);
    CAPTURE(fine);
    CHECK(fine < edge * edge);
    CHECK(coarse > 3 * fine);
  }
}

/// The definition, in double: each face's area vector at all vertices of its corners' particles.
std::vector<Vec3> plain_normals(const MeshDescription& mesh, const MeshCloth& made,
                                const std::vector<Vec3>& particles) {
  std::vector<Vec3> sums(particles.size());
  std::size_t first = 0;
  for (const std::uint32_t size : mesh.face_sizes) {
    std::vector<std::uint32_t> face;
    for (std::size_t i = 0; i < size; ++i)
      face.push_back(made.particle_of_vertex[mesh.corners[first + i]]);
    Vec3 area;
    for (std::size_t i = 2; i < size; ++i) {
      const Vec3 from = particles[face[0]];
      area = area + cross(particles[face[i - 1]] - from, particles[face[i]] - from);
    }
    for (const std::uint32_t corner : face) sums[corner] = sums[corner] + area;
    first += size;
  }
  for (Vec3& sum : sums) sum = unit(sum);
  return sums;
}

TEST_CASE("of any shape, normals and positions are those of their definition") {
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const std::uint32_t size = 3 + random.below(6);
    const auto place = [&](double i, double j) { return Vec3{i, j, 0} + random.in_box(0.3); };
    const MeshDescription mesh = sheet(size, size + 2, place, [&](auto, auto) {
      return std::array{Cut::none, Cut::first, Cut::second}[random.below(3)];
    });
    Drawn drawn(mesh);
    drawn.put([&](Vec3 p) { return p + random.in_box(0.5); });
    const std::vector<Vec3> at = positions(drawn.cloth);
    const std::vector<Vec3> expected = plain_normals(mesh, drawn.made, at);
    const std::vector<Vec3> normals = drawn.normals(), places = drawn.vertices();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const std::uint32_t particle = drawn.made.particle_of_vertex[i];
      CHECK(distance(normals[i], expected[particle]) < 1e-4);
      CHECK(places[i].x == static_cast<float>(at[particle].x));
      CHECK(places[i].y == static_cast<float>(at[particle].y));
      CHECK(places[i].z == static_cast<float>(at[particle].z));
    }
  }
}

TEST_CASE("the back of a two-sided mesh has the normals of its front turned around") {
  MeshDescription mesh = quads(4);
  const auto front = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t v = 0; v < front; ++v) mesh.positions.push_back(mesh.positions[v]);
  const std::vector<std::uint32_t> corners = mesh.corners;
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    for (const std::size_t k : {3u, 2u, 1u, 0u}) mesh.corners.push_back(front + corners[i + k]);
  }
  mesh.face_sizes.insert(mesh.face_sizes.end(), corners.size() / 4, 4);
  Drawn drawn(mesh);
  REQUIRE(drawn.made.counts.double_faces == 9);
  const std::vector<Vec3> normals = drawn.normals();
  const double side = normals[0].z;
  CHECK(std::abs(side) == doctest::Approx(1));
  for (std::size_t v = 0; v < normals.size(); ++v)
    CHECK(distance(normals[v], {0, 0, v < front ? side : -side}) < kRounding);
}

TEST_CASE("what lies between vectors, and vertices that are not drawn, stay as they are") {
  MeshDescription mesh = quads(5);
  mesh.positions.insert(mesh.positions.begin() + 7, {9, 9, 9});
  for (std::uint32_t& corner : mesh.corners) corner += corner >= 7;
  Drawn drawn(mesh);
  REQUIRE(drawn.made.particle_of_vertex[7] == kNoIndex);
  std::vector<float> buffer(26 * 8, -7);
  REQUIRE(drawn.surface.read_vertices(drawn.cloth, {buffer, 8}, {std::span(buffer).subspan(3), 8}));
  const std::vector<Vec3> places = drawn.vertices(), normals = drawn.normals();
  for (std::size_t v = 0; v < 26; ++v) {
    const float* const at = &buffer[8 * v];
    CHECK(distance({at[0], at[1], at[2]}, places[v]) == 0);
    CHECK(distance({at[3], at[4], at[5]}, normals[v]) == 0);
    CHECK(at[6] == -7);
    CHECK(at[7] == -7);
  }
  CHECK(distance(places[7], {-7, -7, -7}) == 0);
  CHECK(distance(normals[7], {-7, -7, -7}) == 0);
}

TEST_CASE("far away, and at any size, normals stay what they are") {
  const auto wave = [](Vec3 p) { return Vec3{p.x, p.y, std::sin(p.x) * std::cos(p.y)}; };
  Drawn drawn(quads(9));
  drawn.put(wave);
  const std::vector<Vec3> expected = drawn.normals(), near = drawn.vertices();
  const Vec3 far{1e6, -2e6, 3e6};
  drawn.put([&](Vec3 p) { return wave(p) + far; });
  const std::vector<Vec3> normals = drawn.normals(), places = drawn.vertices(far);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    CHECK(distance(normals[i], expected[i]) < kRounding);
    CHECK(distance(places[i], near[i]) < 1e-6);
  }
  for (const double size : {1e-9, 1e-5, 1e5, 1e9}) {
    CAPTURE(size);
    MeshDescription scaled = quads(9);
    for (Vec3& p : scaled.positions) p = size * wave(p);
    Drawn of_size(scaled);
    const std::vector<Vec3> found = of_size.normals();
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK(distance(found[i], expected[i]) < kRounding);
  }
}

TEST_CASE("where there is no area the normal is (0, 0, 1)") {
  MeshDescription mesh = quads(4);
  mesh.positions.push_back({3, 4, 0});
  mesh.lines = {{15, 16}};
  Drawn drawn(mesh);
  CHECK(distance(drawn.normals()[16], {0, 0, 1}) == 0);
  drawn.put([](Vec3 p) { return Vec3{0, p.y, 0}; });
  for (const Vec3& n : drawn.normals()) CHECK(distance(n, {0, 0, 1}) == 0);
}

TEST_CASE("the triangles are those of the faces, four-sided ones cut along the shorter diagonal") {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {4, 1, 0}, {1, 1, 0}, {2, 3, 0}, {0, 2, 0}};
  mesh.corners = {0, 1, 2, 3, 3, 2, 4, 1, 2, 4, 5, 3};
  mesh.face_sizes = {4, 3, 5};
  const Drawn drawn(mesh);
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 3}, {1, 2, 3}, {3, 2, 4},
                                                           {1, 2, 4}, {1, 4, 5}, {1, 5, 3}};
  CHECK(std::ranges::equal(drawn.surface.triangles(), expected));
  CHECK(drawn.surface.vertex_count() == 6);
  CHECK(drawn.surface.particle_count() == 6);
}

TEST_CASE("a clone reads the same") {
  Drawn drawn(quads(6));
  drawn.put([](Vec3 p) { return Vec3{p.x, p.y, p.x * p.y}; });
  const std::vector<Vec3> normals = drawn.normals(), places = drawn.vertices();
  drawn.surface = drawn.surface.clone();
  CHECK(largest_distance(drawn.normals(), normals) == 0);
  CHECK(largest_distance(drawn.vertices(), places) == 0);
}

TEST_CASE("what does not fit is refused with one line, and nothing is written") {
  Drawn drawn(quads(5));
  std::vector<float> good(75, -7), bad(74, -7);
  const auto refused = [&](const Cloth& cloth, FloatVectors positions, FloatVectors normals,
                           Vec3 origin, const std::string& line) {
    const auto r = drawn.surface.read_vertices(cloth, positions, normals, origin);
    REQUIRE_FALSE(r);
    CHECK(r.error() == line);
    CHECK(good == std::vector<float>(75, -7));
    CHECK(bad == std::vector<float>(74, -7));
  };
  const std::string need = ": needs 25 vectors of stride 3, and is of the floats (74)";
  refused(drawn.cloth, {good}, {bad}, {}, "normals" + need);
  refused(drawn.cloth, {bad}, {good}, {}, "positions" + need);
  refused(drawn.cloth, {good, 2}, {}, {}, "positions: needs a stride of 3 at least (2)");
  refused(drawn.cloth, {good}, {}, {0, std::nan(""), 0}, "origin: must be finite (0, nan, 0)");
  refused(cloth_of(scene_of("hang", 4), {}), {good}, {good}, {}, "from: needs 25 elements (16)");

  const MeshDescription mesh = quads(5);
  MeshCloth made = drawn.made;
  CHECK(surface_of_mesh(quads(4), made).error() == "particle_of_vertex: needs 16 elements (25)");
  made.particle_of_vertex[3] = 25;
  CHECK(surface_of_mesh(mesh, made).error() ==
        "particle_of_vertex[3]: no such particle, the scene has 25 (25)");
  made.particle_of_vertex[3] = kNoIndex;
  CHECK(surface_of_mesh(mesh, made).error().starts_with("particle_of_vertex[3]: no such particle"));
  MeshDescription odd = mesh;
  odd.corners[2] = 99;
  CHECK(surface_of_mesh(odd, drawn.made).error().starts_with("corners[2]: no such vertex"));
}

/// Two sheets of one row of cells side by side, each with its own vertices along z = 0.
MeshDescription two_panels(double apart) {
  MeshDescription mesh = cut_sheet(
      2, 5,
      [](double row, double column) {
        return Vec3{column, 0.3 * row, row - 1};
      },
      Cut::none);
  const MeshDescription other = cut_sheet(
      2, 5,
      [=](double row, double column) {
        return Vec3{column, 0.3 * (1 - row) + apart, row};
      },
      Cut::none);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const std::uint32_t corner : other.corners) mesh.corners.push_back(corner + first);
  mesh.face_sizes.insert(mesh.face_sizes.end(), other.face_sizes.begin(), other.face_sizes.end());
  for (std::uint32_t k = 0; k < 5; ++k) mesh.seams.push_back({5 + k, first + k});
  mesh.seam_time = 1;
  return mesh;
}

TEST_CASE(
    "both sides of a closed seam have one place and one normal, those of an open one do not") {
  Drawn closed(two_panels(1e-4));
  const auto normals = closed.normals(), places = closed.vertices();
  for (std::uint32_t k = 0; k < 5; ++k) {
    CHECK(distance(normals[5 + k], normals[10 + k]) == 0);
    CHECK(distance(places[5 + k], places[10 + k]) == 0);
    CHECK(std::abs(normals[5 + k].y) > 1 - 1e-3);  // between both slopes
  }
  Drawn open(two_panels(0.2));
  const auto apart = open.normals(), where = open.vertices();
  for (std::uint32_t k = 0; k < 5; ++k) {
    CHECK(distance(apart[5 + k], apart[10 + k]) > 0.3);
    CHECK(distance(where[5 + k], where[10 + k]) == doctest::Approx(0.2));
  }
}

}  // namespace
}  // namespace weft::test::engine_surface_surface
