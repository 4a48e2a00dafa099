#include "tools/scenes/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <string>

#include "perf/meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"
#include "tools/scenes/irregular_mesh.h"

namespace weft::test::tools_scenes_scenes {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SceneDescription made(std::string_view name, const scenes::Options& options) {
  auto scene = scenes::make(name, options);
  REQUIRE_MESSAGE(scene, scene.error());
  return scene.value();
}

/// Edges of the whole N x N grid, less those between fixed neighbours.
std::size_t edges(int n, int inert) { return static_cast<std::size_t>(2 * n * (n - 1) - inert); }

double cloth_mass(const SceneDescription& scene, int n) {
  return std::accumulate(scene.masses.begin(), scene.masses.begin() + n * n, 0.0);
}

TEST_CASE("the list names what make() makes") {
  for (const scenes::BuiltIn& scene : scenes::list()) {
    CAPTURE(std::string(scene.name));
    CHECK(scenes::make(scene.name, {.size = 21}));
    CHECK(!scene.summary.empty());
    CHECK(scenes::find(scene.name) == &scene);
  }
  CHECK(std::ranges::is_sorted(scenes::list(), std::less{}, &scenes::BuiltIn::name));
  CHECK(scenes::find("hangar") == nullptr);
}

/// Some of its particles are several vertices.
bool is_sewn(const scenes::Scene& scene) {
  std::set<std::uint32_t> particles;
  for (const std::uint32_t particle : scene.mesh.particle_of_vertex) {
    if (particle != kNoIndex && !particles.insert(particle).second) return true;
  }
  return false;
}

scenes::Scene made_scene(std::string_view name, int size = 21) {
  return scenes::make_scene(name, {.size = size}).value();
}

void check_at_rest(const SceneDescription& scene) {
  for (const Constraint& c : scene.constraints) {
    const double l = distance(scene.positions[c.a], scene.positions[c.b]);
    REQUIRE(std::abs(l - c.rest_length) < 1e-12 * c.rest_length);
  }
}

TEST_CASE("every edge of what is not sewn starts at its rest length, and every model builds" *
          doctest::test_suite("long")) {
  for (const scenes::BuiltIn& scene : scenes::list()) {
    if (is_sewn(made_scene(scene.name))) continue;
    for (const int size : {3, 5, 21, 101}) {
      CAPTURE(std::string(scene.name));
      CAPTURE(size);
      if (size < scene.smallest_size) continue;
      const SceneDescription description = made(scene.name, {.size = size});
      check_at_rest(description);
      const double rest = scene.name == "chain" ? 0.01 : 1.0 / (size - 1);
      const bool is_mesh = scene.name == "cape" || scene.is_fabric;
      for (const Constraint& c : description.constraints) {
        REQUIRE((c.rest_length == rest || is_mesh));
        REQUIRE(c.kind == ConstraintKind::distance);
      }
      CHECK(description.velocities.empty());
      CHECK(description.gravity.y == -10);
      // A mesh keeps the edges of its pole, or its frame.
      const bool joins_pins = scene.is_fabric && !description.fixed.empty();
      if (!joins_pins) CHECK(describe(*model_of(description)).inert_constraints == 0);
    }
  }
}

TEST_CASE("hang: a level sheet of 1 kg, fixed at i = 0") {
  for (const int n : {2, 6, 20}) {
    CAPTURE(n);
    const SceneDescription scene = made("hang", {.size = n});
    const std::size_t count = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    REQUIRE(scene.positions.size() == count);
    CHECK(scene.masses == std::vector<double>(count, 1.0 / static_cast<double>(count)));
    CHECK(scene.constraints.size() == edges(n, n - 1));
    REQUIRE(scene.fixed.size() == static_cast<std::size_t>(n));
    for (int j = 0; j < n; ++j)
      CHECK(scene.fixed[static_cast<std::size_t>(j)] == static_cast<std::uint32_t>(j));
    CHECK(distance(scene.positions[count - 1], {1, 0, 1}) == 0);
    CHECK(distance(scene.positions[1], {0, 0, 1.0 / (n - 1)}) < 1e-15);
    CHECK(scene.spheres.empty());
    CHECK(scene.radii.empty());
  }
}

TEST_CASE("hang_sphere: hang and one fixed sphere behind it") {
  const SceneDescription scene = made("hang_sphere", {.size = 6});
  REQUIRE(scene.positions.size() == 37);
  CHECK(scene.spheres == std::vector<std::uint32_t>{36});
  CHECK(scene.fixed == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 36});
  CHECK(distance(scene.positions[36], {0.5, -0.6, 0.5}) == 0);
  CHECK(scene.radii[36] == 0.25);
  CHECK(std::count(scene.radii.begin(), scene.radii.end(), 0.0) == 36);
  CHECK(cloth_mass(scene, 6) == doctest::Approx(1).epsilon(1e-12));
  CHECK(scene.constraints.size() == edges(6, 5));
}

TEST_CASE("sphere_drop: the sheet spans 1 - slack and sags as a circular arc") {
  for (const int n : {3, 4, 20, 21}) {
    for (const double slack : {0.0, 1e-9, 0.05, 0.5}) {
      CAPTURE(n);
      CAPTURE(slack);
      const SceneDescription scene = made("sphere_drop", {.size = n, .slack = slack});
      const Vec3 first = scene.positions[0];
      const Vec3 last = scene.positions[static_cast<std::size_t>(n - 1)];
      CHECK(distance(first, last) == doctest::Approx(1 - slack).epsilon(1e-12));
      CHECK(std::abs(first.y - last.y) < 1e-12);
      for (int j = 2; j + 1 < n; ++j) {
        const auto at = [&](int k) { return scene.positions[static_cast<std::size_t>(k)]; };
        const double chord = distance(at(0), at(2));
        REQUIRE(distance(at(j - 1), at(j + 1)) == doctest::Approx(chord).epsilon(1e-12));
      }
      CHECK(scene.fixed.size() == static_cast<std::size_t>(2 * n));
      CHECK(scene.constraints.size() == edges(n, 2 * (n - 1)));
      CHECK(cloth_mass(scene, n) == doctest::Approx(1).epsilon(1e-12));
    }
  }
}

TEST_CASE("sphere_drop: the sphere's lowest point is 0.3 m above the middle") {
  for (const int n : {20, 21}) {
    for (const double slack : {0.0, 0.05}) {
      const SceneDescription scene =
          made("sphere_drop", {.size = n, .slack = slack, .sphere_mass = 7});
      const auto sphere = static_cast<std::size_t>(n * n);
      double lowest = 0;
      for (std::size_t i = 0; i < sphere; ++i) lowest = std::min(lowest, scene.positions[i].y);
      const Vec3 expected{0.5, lowest + 0.45, (1 - slack) / 2};
      CHECK(distance(scene.positions[sphere], expected) < 1e-12);
      CHECK(scene.radii[sphere] == 0.15);
      CHECK(scene.masses[sphere] == 7);
      CHECK(std::count(scene.fixed.begin(), scene.fixed.end(), sphere) == 0);
      CHECK((lowest < 0) == (slack > 0));
    }
  }
}

TEST_CASE("corners: folded along its middle row, hung from two corners") {
  const SceneDescription scene = made("corners", {.size = 5});
  CHECK(scene.fixed == std::vector<std::uint32_t>{0, 4});
  CHECK(scene.constraints.size() == edges(5, 0));
  CHECK(distance(scene.positions[2], {0, -std::sqrt(0.19) / 2, 0.45}) < 1e-15);
  CHECK(distance(scene.positions[23], {1, -std::sqrt(0.19) / 4, 0.675}) < 1e-15);
  CHECK(distance(scene.positions[4], {0, 0, 0.9}) < 1e-15);
  CHECK(cloth_mass(scene, 5) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("banner: upright, hung from two corners at its own width") {
  const SceneDescription scene = made("banner", {.size = 4});
  CHECK(scene.fixed == std::vector<std::uint32_t>{0, 3});
  CHECK(scene.constraints.size() == edges(4, 0));
  CHECK(distance(scene.positions[3], {0, 0, 1}) < 1e-15);
  CHECK(distance(scene.positions[13], {0, -1, 1.0 / 3}) < 1e-15);
  CHECK(cloth_mass(scene, 4) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("four_pins: a level sheet of 1 kg between its corners") {
  for (const int n : {3, 6}) {
    CAPTURE(n);
    const SceneDescription scene = made("four_pins", {.size = n});
    const auto last = static_cast<std::uint32_t>(n - 1), row = static_cast<std::uint32_t>(n);
    CHECK(scene.fixed == std::vector<std::uint32_t>{0, last, last * row, last * row + last});
    CHECK(scene.constraints.size() == edges(n, 0));
    CHECK(distance(scene.positions[last], {0, 0, 1}) == 0);
    CHECK(distance(scene.positions[last * row], {1, 0, 0}) == 0);
    CHECK(distance(scene.positions[last * row + last], {1, 0, 1}) == 0);
    CHECK(distance(scene.positions[row + 1], {1.0 / (n - 1), 0, 1.0 / (n - 1)}) < 1e-15);
    CHECK(cloth_mass(scene, n) == doctest::Approx(1).epsilon(1e-12));
    CHECK(scene.spheres.empty());
  }
}

TEST_CASE(
    "diagonals: two ropes in every cell of every grid, at rest, beside the edges as they were") {
  for (const std::string_view name :
       {"hang", "hang_sphere", "sphere_drop", "corners", "banner", "four_pins"}) {
    for (const int size : {3, 21}) {
      CAPTURE(std::string(name));
      CAPTURE(size);
      const SceneDescription plain = made(name, {.size = size});
      const SceneDescription scene = made(name, {.size = size, .diagonals = true});
      check_at_rest(scene);
      const auto cells = static_cast<std::size_t>((size - 1) * (size - 1));
      const std::size_t first = plain.constraints.size();
      REQUIRE(scene.constraints.size() == first + 2 * cells);
      for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
        const Constraint c = scene.constraints[i];
        const bool is_rope = c.kind == ConstraintKind::rope;
        REQUIRE(is_rope == (i >= first));
        if (is_rope) REQUIRE(c.rest_length == std::sqrt(2.0) * (1.0 / (size - 1)));
      }
      CHECK(scene.positions.size() == plain.positions.size());
      CHECK(scene.fixed == plain.fixed);
      CHECK(describe(*model_of(scene)).inert_constraints == 0);  // nor twice between any two
    }
  }
}

TEST_CASE("flag and drape are of a material, which may be another") {
  const Material cotton = find_material("cotton").value(), silk = find_material("silk").value();
  for (const std::string_view name : {"flag", "drape"}) {
    CAPTURE(std::string(name));
    const SceneDescription scene = made(name, {.size = 11});
    CHECK(cloth_mass(scene, 11) == doctest::Approx(cotton.density));
    const ModelInfo info = describe(*model_of(scene));
    CHECK(info.compliant == info.constraints);
    CHECK(!scene.bending.empty());
    CHECK(scene.air.triangles.size() == 2 * 10 * 10);
    CHECK(cloth_mass(made(name, {.size = 11, .material = silk}), 11) ==
          doctest::Approx(silk.density));
  }
  CHECK(made("flag", {.size = 11}).air.wind.x == 8);
  CHECK(made("flag", {.size = 11}).fixed.size() == 11);
  CHECK(made("drape", {.size = 11}).spheres == std::vector<std::uint32_t>{121});
}

TEST_CASE("every grid can be of a material, and the rest of the scene stays what it is") {
  const Material cotton = find_material("cotton").value();
  for (const std::string_view name :
       {"hang", "hang_sphere", "sphere_drop", "corners", "banner", "four_pins"}) {
    CAPTURE(std::string(name));
    const SceneDescription rigid = made(name, {.size = 11});
    const SceneDescription scene = made(name, {.size = 11, .material = cotton});
    CHECK(cloth_mass(scene, 11) == doctest::Approx(cotton.density));
    CHECK(scene.air.triangles.size() == 2 * 10 * 10);
    CHECK(largest_distance(scene.positions, rigid.positions) == 0);
    CHECK(scene.fixed == rigid.fixed);
    CHECK(scene.radii == rigid.radii);
    for (const BendingElement& element : scene.bending) REQUIRE(element.rest < 1e-12);
    const ModelInfo info = describe(*model_of(scene));
    CHECK(info.compliant == info.constraints);
  }
}

TEST_CASE("ropes and diagonals of a cloth of a material only pull") {
  const Material cotton = find_material("cotton").value();
  const auto ropes = [&](const scenes::Options& options) {
    const SceneDescription scene = made("hang", options);
    return std::ranges::count(scene.constraints, ConstraintKind::rope, &Constraint::kind);
  };
  const std::ptrdiff_t all = std::ssize(made("hang", {.size = 11, .material = cotton}).constraints);
  CHECK(ropes({.size = 11, .material = cotton}) == 0);
  CHECK(ropes({.size = 11, .diagonals = true, .material = cotton}) == 2 * 10 * 10);
  CHECK(ropes({.size = 11, .ropes = true, .material = cotton}) == all);
  CHECK(ropes({.size = 11, .ropes = true}) == std::ssize(made("hang", {.size = 11}).constraints));
}

TEST_CASE("the mesh of a scene is its faces; that of a chain is its line") {
  for (const scenes::BuiltIn& entry : scenes::list()) {
    const scenes::Scene scene = made_scene(entry.name);
    if (is_sewn(scene)) continue;
    CAPTURE(std::string(entry.name));
    const auto& [description, mesh, bodies, moves] = scene;
    const bool is_chain = entry.name == "chain";
    CHECK(mesh.faces.empty() == is_chain);
    CHECK(mesh.lines.empty() != is_chain);
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
      const std::uint32_t particle = mesh.particle_of_vertex[vertex];
      if (particle == kNoIndex) continue;
      REQUIRE(distance(mesh.vertices[vertex], description.positions[particle]) == 0);
    }
  }
  for (const std::string_view name : {"hang", "cape", "drape", "fold", "funnel"})
    CHECK(made_scene(name).mesh.vertices.size() == 441);
  CHECK(made_scene("chain").mesh.vertices.size() == 21);
}

TEST_CASE("a flag flies, and a sheet comes to hang over its sphere") {
  Cloth flag = cloth_of(made("flag", {.size = 11}), {});
  Cloth drape = cloth_of(made("drape", {.size = 11}), {});
  for (int frame = 0; frame < 60; ++frame) {
    for (Cloth* cloth : {&flag, &drape}) {
      const StepReport report = step(*cloth, 1. / 60);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_error <= 0.01);
      REQUIRE(report.max_penetration <= 1e-4);
    }
  }
  CHECK(flag.position(120).x > 0.5);
  CHECK(flag.position(120).z > 0.05);
  const double height = distance(drape.position(60), {0.5, -0.31, 0.5});
  CHECK(height > 0.2999);  // on the sphere, wherever it slides to
  CHECK(height < 0.33);
  CHECK(drape.position(0).y < -0.2);  // a corner
}

TEST_CASE("of diagonals those between two fixed particles are left out") {
  const SceneDescription smallest = made("hang", {.size = 2, .diagonals = true});
  CHECK(smallest.constraints.size() == 3 + 2);
}

TEST_CASE("cape: the mesh of the benchmarks, without what joins fixed particles") {
  constexpr int kSize = 120;
  const SceneDescription whole = perf::irregular(kSize);
  const SceneDescription scene = made("cape", {.size = kSize});
  REQUIRE(scene.positions.size() == 14'400);
  CHECK(whole.constraints.size() == 41'088);
  CHECK(largest_distance(scene.positions, whole.positions) == 0);
  CHECK(scene.masses == std::vector<double>(14'400, 1.0 / 14'400));
  CHECK(scene.fixed.size() == 210);
  std::vector<bool> is_fixed(scene.positions.size(), false);
  for (const std::uint32_t particle : scene.fixed) is_fixed[particle] = true;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    REQUIRE(is_fixed[i] == (scene.positions[i].x < 0.01));
  }
  std::size_t next = 0;
  for (const Constraint& c : whole.constraints) {
    if (is_fixed[c.a] && is_fixed[c.b]) continue;
    REQUIRE(next < scene.constraints.size());
    const Constraint found = scene.constraints[next++];
    REQUIRE((found.a == c.a && found.b == c.b && found.rest_length == c.rest_length));
    REQUIRE(found.kind == ConstraintKind::distance);
  }
  CHECK(next == scene.constraints.size());
  CHECK(next < whole.constraints.size());
}

TEST_CASE("cape: its edges may be ropes, of the same lengths") {
  const SceneDescription bars = made("cape", {.size = 20});
  const SceneDescription ropes = made("cape", {.size = 20, .ropes = true});
  REQUIRE(ropes.constraints.size() == bars.constraints.size());
  for (std::size_t i = 0; i < ropes.constraints.size(); ++i) {
    REQUIRE(ropes.constraints[i].kind == ConstraintKind::rope);
    REQUIRE(ropes.constraints[i].rest_length == bars.constraints[i].rest_length);
  }
  check_at_rest(ropes);
}

TEST_CASE("the irregular mesh joins neighbours of a grid, and leaves some cells open") {
  const scenes::IrregularMesh mesh = scenes::irregular_mesh(30);
  std::size_t triangles = 0, quads = 0;
  for (const scenes::Face& face : mesh.faces) {
    (face.size() == 3 ? triangles : quads) += 1;
    REQUIRE((face.size() == 3 || face.size() == 4));
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3 a = mesh.points[face[k]], b = mesh.points[face[(k + 1) % face.size()]];
      REQUIRE(distance(a, b) < 1.6 * std::sqrt(2.0) / 29);
    }
  }
  constexpr double kCells = 29 * 29;
  CHECK(static_cast<double>(quads) == doctest::Approx(0.1 * kCells).epsilon(0.3));
  CHECK(static_cast<double>(triangles) == doctest::Approx(2 * 0.88 * kCells).epsilon(0.05));
  CHECK(mesh.first_row.size() == 30);
  for (const std::uint32_t point : mesh.first_row) CHECK(std::abs(mesh.points[point].x) < 0.3 / 29);
}

TEST_CASE("chain: a level line with a heavy end") {
  const SceneDescription scene = made("chain", {.size = 20, .end_mass = 1e6});
  CHECK(scene.positions.size() == 20);
  CHECK(scene.constraints.size() == 19);
  CHECK(scene.fixed == std::vector<std::uint32_t>{0});
  CHECK(scene.masses[18] == 1);
  CHECK(scene.masses[19] == 1e6);
  CHECK(distance(scene.positions[19], {0.19, 0, 0}) < 1e-15);
}

void check_refused(std::string_view name, const scenes::Options& options, const char* option,
                   const char* value) {
  const auto scene = scenes::make(name, options);
  REQUIRE_FALSE(scene);
  const std::string& message = scene.error();
  CAPTURE(message);
  CHECK(message.find(name) != std::string::npos);
  CHECK(message.find(option) != std::string::npos);
  CHECK(message.find(value) != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

TEST_CASE("options out of range are refused by name and value") {
  check_refused("hang", {.size = 1}, "size", "1");
  check_refused("hang", {.size = -7}, "size", "-7");
  check_refused("hang_sphere", {.size = 2'000'000'000}, "size", "2000000000");
  check_refused("sphere_drop", {.size = 2}, "size", "2");
  check_refused("corners", {.size = 1}, "size", "1");
  check_refused("corners", {.size = 20}, "size", "20");
  check_refused("banner", {.size = 2}, "size", "2");
  check_refused("four_pins", {.size = 2}, "size", "2");
  check_refused("cape", {.size = 2}, "size", "2");
  check_refused("chain", {.size = 1}, "size", "1");
  check_refused("chain", {.end_mass = 0}, "end_mass", "0");
  check_refused("chain", {.material = find_material("silk").value()}, "material", "particles");
  check_refused("chain", {.end_mass = kNan}, "end_mass", "nan");
  check_refused("sphere_drop", {.slack = -0.25}, "slack", "-0.25");
  check_refused("sphere_drop", {.slack = 1}, "slack", "1");
  check_refused("sphere_drop", {.slack = kNan}, "slack", "nan");
  check_refused("sphere_drop", {.sphere_mass = -3}, "sphere_mass", "-3");
  check_refused("sphere_drop", {.sphere_mass = HUGE_VAL}, "sphere_mass", "inf");
}

TEST_CASE("an unknown scene is refused, and the known ones are named") {
  check_refused("hangar", {}, "hangar", "sphere_drop");
}

}  // namespace
}  // namespace weft::test::tools_scenes_scenes
