/// Bodies and moves of a scene file.
#include <doctest/doctest.h>
#include <weft/shape_fields.h>

#include <cmath>
#include <numbers>

#include "engine/bodies/body_mass.h"
#include "tests/support/shapes.h"
#include "tests/tools/scene_texts.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"
#include "tools/program/measure/crossings.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

using namespace test::scene_texts;

TEST_CASE("bodies survive writing and reading, and move as they are told") {
  SceneDescription scene;
  scene.positions = {{0, 1, 0}};
  scene.masses = {1};
  scene.friction = 0.45;
  std::vector<SceneBody> bodies{{.shape = Plane{{0, 2, 0}, -0.5}, .friction = 0.1},
                                {.shape = Capsule{{0, 0, 0}, {0, 1, 0}, 0.2, 0.1},
                                 .position = {1, 2, 3},
                                 .thickness = 0.002,
                                 .move = PinMove{.times = {0, 2},
                                                 .translations = {{0, 0, 0}, {4, 0, 0}},
                                                 .rotations = {{0, 0, 0}, {0, 0, 0.5}},
                                                 .about = {1, 2, 3}}},
                                {.shape = box({1, 2, 3})},
                                {.shape = Ball{{0, 1, 0}, 0.25}, .rotation = {0, 1, 0.5}}};
  for (const ShapeDescription& shape : test::shapes_of_size(0.25))
    bodies.push_back({.shape = shape});
  const std::string text = scene_text(scene, {}, {}, bodies);
  const auto read = parse_scene(text);
  REQUIRE_MESSAGE(read, (read ? "" : read.error()));
  CHECK(read.value().description.friction == 0.45);
  REQUIRE(read.value().bodies.size() == bodies.size());
  CHECK(scene_text(read.value().description, {}, {}, read.value().bodies) == text);
  CHECK(read.value().bodies[3].rotation.z == 0.5);  // to the last bit
  const Pose pose = pose_at(read.value().bodies[1], 1);
  CHECK(pose.position.x == 3);
  CHECK(pose.rotation.z == doctest::Approx(std::sin(0.125)));
  CHECK(pose_at(present_bodies(read.value().bodies, 1)[1], 0).position.x == 3);
}

/// The bodies of a scene file with one particle.
Result<std::vector<SceneBody>> bodies_of(const std::string& bodies) {
  const auto read =
      parse_scene(R"({"positions": [[0, 0, 0]], "masses": [1], "bodies": )" + bodies + "}");
  if (!read) return Error{read.error()};
  return read.value().bodies;
}

TEST_CASE("bodies with a mass are full ones, or what their inertia says, and survive writing") {
  const auto read = bodies_of(R"([
      {"shape": "sphere", "centre": [0, 1, 0], "radius": 0.1, "mass": 2, "spin": [0, 3, 0]},
      {"shape": "box", "size": [0.1, 0.2, 0.4], "density": 1000, "velocity": [1, 0.1, 0]},
      {"shape": "capsule", "a": [0, 0, 0], "b": [1, 0, 0], "radius": 0.1,
       "mass": {"mass": 3, "inertia": [1, 2, 2, 0.1, 0, 0]}},
      {"shape": "capsule", "a": [0, 0, 0], "b": [1, 0, 0], "radius": 0.1,
       "mass": {"mass": 3, "centre": [0.3, 0, 0], "inertia": [1, 2, 2, 0.1, 0, 0]}}])");
  REQUIRE_MESSAGE(read, (read ? "" : read.error()));
  const std::vector<SceneBody>& bodies = read.value();
  CHECK(bodies[0].mass->mass == 2);
  CHECK(bodies[0].mass->centre.y == doctest::Approx(1));
  CHECK(bodies[0].mass->inertia[0] == doctest::Approx(0.4 * 2 * 0.01));
  CHECK(bodies[0].velocity.angular.y == 3);
  CHECK(bodies[1].mass->mass == doctest::Approx(8));
  CHECK(bodies[1].velocity.linear.y == 0.1);
  CHECK(bodies[2].mass->centre.x == doctest::Approx(0.5));
  CHECK(bodies[3].mass->centre.x == 0.3);
  CHECK(bodies[3].mass->inertia == std::array<double, 6>{1, 2, 2, 0.1, 0, 0});
  SceneDescription scene;
  scene.positions = {{0, 1, 0}};
  scene.masses = {1};
  const std::string text = scene_text(scene, {}, {}, bodies);
  const auto again = parse_scene(text);
  REQUIRE_MESSAGE(again, (again ? "" : again.error()));
  CHECK(scene_text(scene, {}, {}, again.value().bodies) == text);
  CHECK(again.value().bodies[0].mass->inertia == bodies[0].mass->inertia);
}

TEST_CASE("masses that no body has are refused with their place") {
  const auto error_of = [](const std::string& rest) {
    const auto read = bodies_of("[{" + rest + "}]");
    return read ? std::string() : read.error();
  };
  const std::string ball = R"("shape": "sphere", "radius": 0.1, )";
  const std::string mesh =
      R"("shape": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]], )";
  CHECK(error_of(ball + R"("mass": 0)") == "bodies[0].mass: must be finite and greater than 0 (0)");
  CHECK(error_of(ball + R"("density": -1)") ==
        "bodies[0].density: must be finite and greater than 0 (-1)");
  CHECK(error_of(ball + R"("mass": "1 kg")") == R"(bodies[0].mass: expected a number, not "1 kg")");
  CHECK(error_of(ball + R"("mass": 1, "density": 1)") ==
        "bodies[0]: expected one of the keys 'mass' and 'density'");
  CHECK(error_of(mesh + R"("mass": 1)") ==
        "bodies[0].shape: has a mass as " + shapes_with_mass() + " alone (a triangle mesh)");
  CHECK(error_of(R"("shape": "plane", "density": 1000)") ==
        "bodies[0].shape: has a mass as " + shapes_with_mass() + " alone (a plane)");
  CHECK(error_of(ball + R"("mass": 1, "moves": {"times": [0], "translations": [[0,0,0]]})") ==
        "bodies[0].moves: a body with a mass moves by itself");
  CHECK(error_of(ball + R"("spin": [0, 1, 0])") ==
        "bodies[0].spin: is of a body with a mass alone");
  CHECK(error_of(ball + R"("mass": {"mass": 1})") ==
        "bodies[0].mass: the key 'inertia' is missing");
  CHECK(error_of(ball + R"("mass": {"mass": 1, "inertia": [1, 1, 1]})") ==
        "bodies[0].mass.inertia: expected xx, yy, zz, yz, zx and xy, not [1,1,1]");
  CHECK(error_of(ball + R"("mass": {"mass": 1, "inertia": [1, 1, 3, 0, 0, 0]})") ==
        "bodies[0].mass.inertia: is that of no body (1, 1, 3, 0, 0, 0)");
  CHECK(error_of(ball + R"("mass": {"mass": 1, "inertia": [1, 1, 1, 0, 0, 0], "size": 1})") ==
        "bodies[0].mass: unknown key 'size'");
}

/// One triangle whose third corner rises by a metre in two seconds.
SceneBody rising_triangle() {
  const std::vector<Vec3> low{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, high{low[0], low[1], {1, 1, 0}};
  return {.shape = TriangleMesh{low, {{0, 1, 2}}, true},
          .vertex_move = VertexMove{{0, 2}, {low, high}}};
}

TEST_CASE("meshes survive writing and reading, and their vertices move") {
  SceneDescription scene;
  scene.positions = {{0, 1, 0}};
  scene.masses = {1};
  const std::string text = scene_text(scene, {}, {}, {rising_triangle()});
  const auto read = parse_scene(text);
  REQUIRE_MESSAGE(read, (read ? "" : read.error()));
  const std::vector<SceneBody>& bodies = read.value().bodies;
  CHECK(scene_text(scene, {}, {}, bodies) == text);
  CHECK(count_triangles(bodies) == 1);
  CHECK(vertices_at(bodies[0], -1)[2].y == 0);
  CHECK(vertices_at(bodies[0], 0.5)[2].y == 0.25);
  CHECK(vertices_at(bodies[0], 9)[2].y == 1);
  CHECK(vertices_at(present_bodies(bodies, 1)[0], 0)[2].y == 0.5);
}

TEST_CASE("meshes are where their pose is") {
  SceneBody body = rising_triangle();
  body.position = {10, 0, 0};
  body.rotation = {0, 0, std::numbers::pi / 2};
  const TriangleSet set = meshes_at(std::vector{SceneBody{.shape = Ball{.radius = 1}}, body}, 2);
  REQUIRE(set.places.size() == 3);
  CHECK(set.places[2].x == doctest::Approx(9));
  CHECK(set.places[2].y == doctest::Approx(1));
}

TEST_CASE("a mesh may be in a file beside the scene") {
  const TemporaryFolder folder;
  folder.write("body.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
  const std::string start = R"({"positions": [[0, 0, 0]], "masses": [1], "bodies": [)";
  const std::string path = folder.write(
      "scene.json", start + R"({"shape": "mesh", "file": "body.obj", "two_sided": true}]})");
  const auto read = read_scene_file(path);
  REQUIRE_MESSAGE(read, (read ? "" : read.error()));
  const auto& mesh = std::get<TriangleMesh>(read.value().bodies[0].shape);
  CHECK(mesh.vertices.size() == 3);
  CHECK(mesh.two_sided);
  const auto without = parse_scene(start + R"({"shape": "mesh", "file": "no.obj"}]})");
  REQUIRE_FALSE(without);
  CHECK(without.error().starts_with("bodies[0].file: "));
  const auto two_lines = parse_scene(start + R"({"shape": "mesh", "file": "a\nb.obj"}]})");
  REQUIRE_FALSE(two_lines);
  CHECK(two_lines.error() ==
        R"(bodies[0].file: expected the name of an .obj file, not "a\nb.obj")");
}

TEST_CASE("errors of bodies name their place") {
  const auto error_of = [](const std::string& bodies) {
    const auto read = bodies_of(bodies);
    return read ? std::string() : read.error();
  };
  std::string names;
  for_each_shape([&]<class Shape> { names += std::string(kShapeKind<Shape>.name) + ", "; });
  CHECK(error_of(R"([{"shape": "cone"}])") ==
        "bodies[0].shape: expected " + names + "or box, not \"cone\"");
  CHECK(error_of(R"([{"shape": "sphere"}])") == "bodies[0]: the key 'radius' is missing");
  CHECK(error_of(R"([{"shape": "sphere", "radius": 0}])") ==
        "bodies[0].radius: must be finite and greater than 0 (0)");
  CHECK(error_of(R"([{"shape": "plane", "size": 1}])") == "bodies[0]: unknown key 'size'");
  CHECK(error_of(R"([{"shape": "plane", "moves": {"times": [0]}}])") ==
        "bodies[0].moves: the key 'translations' is missing");
  const std::string mesh =
      R"([{"shape": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]])";
  CHECK(error_of(mesh + R"(, "vertex_moves": {"times": [0], "vertices": []}}])") ==
        "bodies[0].vertex_moves.vertices: expected as many as times, 1, not 0");
  CHECK(error_of(mesh + R"(, "vertex_moves": {"times": [0], "vertices": [[[0,0,0]]]}}])") ==
        "bodies[0].vertex_moves.vertices[0]: expected the vertices of the mesh, 3, not 1");
  CHECK(error_of(R"([{"shape": "plane", "vertex_moves": {}}])") ==
        "bodies[0]: unknown key 'vertex_moves'");
}

TEST_CASE("moves survive writing and reading to the last bit") {
  const SceneDescription scene = scenes::make("hang", {.size = 4}).value();
  const std::vector<PinMove> moves{
      {.particles = {3, 1},
       .times = {-1e-300, 0.1, 1.0 / 3},
       .translations = {{0.1, 0.2, 0.3}, {1e-300, -0.0, 4e5}, {0, 0, 2.0 / 3}},
       .rotations = {{0, 0, 0}, {0.1, 0.7, -0.9}, {3, 2, 1e-17}},
       .about = {0.1, 1.0 / 3, -5},
       .from = {{0.3, 0.2, 0.1}, {7, 8, 1.0 / 9}}},
      {.particles = {0}, .times = {0}, .translations = {{0, 0, 0}}}};
  const auto again = parse_scene(scene_text(scene, moves));
  REQUIRE(again);
  check_same(scene, again.value().description);
  REQUIRE(again.value().moves.size() == 2);
  for (std::size_t m = 0; m < 2; ++m) check_same(moves[m], again.value().moves[m]);
}

TEST_CASE("of a move only particles, times and translations must be given") {
  const auto scene = parse_scene(R"({"moves": [{"translations": [[1,2,3]], "times": [0.5],
      "particles": [1]}], "positions": [[0,0,0],[3,4,0]], "total_mass": 3, "fixed": [1]})");
  REQUIRE(scene);
  REQUIRE(scene.value().moves.size() == 1);
  check_same(scene.value().moves[0],
             {.particles = {1}, .times = {0.5}, .translations = {{1, 2, 3}}});
}

TEST_CASE("errors of moves name their place") {
  const auto with = [](const std::string& moves) {
    return error_with(R"("fixed": [0], "moves": )" + moves);
  };
  /// After particles [0], times [0, 1] and two translations.
  const auto with_key = [&](const std::string& more) {
    return with(R"([{"particles": [0], "times": [0,1], "translations": [[0,0,0],[0,0,0]], )" +
                more + "}]");
  };
  const auto with_times = [&](const std::string& times) {
    return with(R"([{"particles": [0], "translations": [], "times": )" + times + "}]");
  };
  const auto with_particles = [&](const std::string& particles) {
    return with(R"([{"times": [0], "translations": [[0,0,0]], "particles": )" + particles + "}]");
  };
  CHECK(with("{}") == "moves: expected an array, not {}");
  CHECK(with("[3]") == "moves[0]: expected an object, not 3");
  CHECK(with("[{}]") == "moves[0]: the key 'particles' is missing");
  CHECK(with(R"([{"particles": []}])") == "moves[0]: the key 'times' is missing");
  CHECK(with(R"([{"particles": [], "times": [0]}])") ==
        "moves[0]: the key 'translations' is missing");
  CHECK(with_key(R"("speed": 3)") == "moves[0]: unknown key 'speed'");
  CHECK(with_key(R"("times": [0,1])") == "the key 'times' is given twice");

  CHECK(with_times("[0,1,1]") == "moves[0].times[2]: expected a time after 1, not 1");
  CHECK(with_times("[0.5,0.25]") == "moves[0].times[1]: expected a time after 0.5, not 0.25");
  CHECK(with_times("[0,null]") == "moves[0].times[1]: expected a number, not null");
  CHECK(with_times("[]") == "moves[0].times: expected one time at least, not []");
  CHECK(with_times("[1e999]").find("1e999") != std::string::npos);
  CHECK(with_times("[0]") == "moves[0].translations: expected as many as times, 1, not 0");

  CHECK(with_key(R"("rotations": [[0,0,1]])") ==
        "moves[0].rotations: expected as many as times, 2, not 1");
  CHECK(with_key(R"("rotations": [[0,0,1],[0,"x",0]])") ==
        R"(moves[0].rotations[1][1]: expected a number, not "x")");
  CHECK(with_key(R"("about": 0)") == "moves[0].about: expected [x, y, z], not 0");
  CHECK(with_key(R"("from": [[0,0,0],[0,0,0]])") ==
        "moves[0].from: expected as many as particles, 1, not 2");

  CHECK(with_particles("[-1]") == "moves[0].particles[0]: expected a particle number, not -1");
  CHECK(with_particles("[1]") == "moves[0].particles[0]: particle 1 is not fixed");
  CHECK(with_particles("[0,7]") == "moves[0].particles[1]: particle 7 is not fixed");
  CHECK(with_particles("[0,0]") == "moves[0].particles[1]: particle 0 is moved twice");
  const std::string still = R"({"particles": [0], "times": [0], "translations": [[0,0,0]]})";
  CHECK(with('[' + still + ',' + still + ']') ==
        "moves[1].particles[0]: particle 0 is moved twice");
}

}  // namespace
}  // namespace weft::tools
