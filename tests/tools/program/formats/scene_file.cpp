#include "tools/program/formats/scene_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/tools/temporary_folder.h"
#include "tools/program/measure/crossings.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

bool same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool same(const Constraint& a, const Constraint& b) {
  return a.a == b.a && a.b == b.b && a.rest_length == b.rest_length && a.kind == b.kind;
}

template <class Value>
bool same(const std::vector<Value>& a, const std::vector<Value>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Value& x, const Value& y) { return same(x, y); });
}

void check_same_material(const SceneDescription& a, const SceneDescription& b) {
  REQUIRE(a.bending.size() == b.bending.size());
  for (std::size_t i = 0; i < a.bending.size(); ++i) {
    CHECK(a.bending[i].particles == b.bending[i].particles);
    CHECK(a.bending[i].weights == b.bending[i].weights);
    CHECK(a.bending[i].rest == b.bending[i].rest);
    CHECK(a.bending[i].fold == b.bending[i].fold);
    CHECK(a.bending[i].compliance == b.bending[i].compliance);
  }
  CHECK(a.damping.stretch == b.damping.stretch);
  CHECK(a.damping.bending == b.damping.bending);
  REQUIRE(a.anchors.size() == b.anchors.size());
  for (std::size_t i = 0; i < a.anchors.size(); ++i) {
    CHECK(a.anchors[i].particle == b.anchors[i].particle);
    CHECK(same(a.anchors[i].point, b.anchors[i].point));
    CHECK(same(a.anchors[i].normal, b.anchors[i].normal));
    CHECK(a.anchors[i].max_distance == b.anchors[i].max_distance);
    CHECK(a.anchors[i].backstop_distance == b.anchors[i].backstop_distance);
    CHECK(a.anchors[i].backstop_radius == b.anchors[i].backstop_radius);
  }
  CHECK(a.damping.motion == b.damping.motion);
  CHECK(a.air.triangles == b.air.triangles);
  CHECK(a.air.density == b.air.density);
  CHECK(a.air.drag == b.air.drag);
  CHECK(a.air.lift == b.air.lift);
  CHECK(a.air.ram == b.air.ram);
  CHECK(a.pressures == b.pressures);
  CHECK(same(a.air.wind, b.air.wind));
}

void check_same(const SceneDescription& a, const SceneDescription& b) {
  check_same_material(a, b);
  CHECK(same(a.gravity, b.gravity));
  CHECK(same(a.positions, b.positions));
  CHECK(same(a.velocities, b.velocities));
  CHECK(same(a.constraints, b.constraints));
  CHECK(a.masses == b.masses);
  CHECK(a.fixed == b.fixed);
  CHECK(a.spheres == b.spheres);
  CHECK(a.radii == b.radii);
  CHECK(a.surface == b.surface);
}

/// The error of a scene of two particles with one more key, or with the text as it is.
std::string error_of(const std::string& text) {
  const auto scene = parse_scene(text);
  REQUIRE_FALSE(scene);
  return scene.error();
}
std::string error_with(const std::string& more) {
  return error_of(R"({"positions": [[0,0,0],[3,4,0]], "total_mass": 1, )" + more + "}");
}

TEST_CASE("every built-in scene survives writing and reading to the last bit") {
  for (const scenes::BuiltIn& built_in : scenes::list()) {
    CAPTURE(built_in.name);
    const auto scene = scenes::make(built_in.name, {.size = 21});
    REQUIRE(scene);
    const auto again = parse_scene(scene_text(scene.value()));
    REQUIRE(again);
    check_same(scene.value(), again.value().description);
    CHECK(again.value().moves.empty());
  }
}

TEST_CASE("velocities and ropes survive writing and reading") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.1, 1.0 / 3, 1e-300}};
  scene.velocities = {{1, 2, 3}, {-0.1, 0, 4e5}};
  scene.masses = {1, 0.3};
  scene.constraints = {{0, 1, 0.7, ConstraintKind::rope}};
  scene.gravity = {0, 0, -9.81};
  const auto again = parse_scene(scene_text(scene));
  REQUIRE(again);
  check_same(scene, again.value().description);
}

TEST_CASE("pressures survive writing and reading to the last bit") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  scene.masses = {1, 1, 1, 1};
  scene.surface = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  scene.air.triangles = {{0, 1, 2}};
  scene.air.ram = 1.0 / 3;
  scene.pressures = {{.pressure = -0.1},
                     {.pressure = 1.0 / 7, .triangles = {2, 0}},
                     {.pressure = 5, .gas = true, .volume = 1.0 / 9, .ambient = 1e5 / 3}};
  const auto again = parse_scene(scene_text(scene));
  REQUIRE(again);
  check_same(scene, again.value().description);
  CHECK(error_with(R"("pressures": [{"triangles": [1]}])") ==
        "pressures[0]: the key 'pressure' is missing");
  CHECK(error_with(R"("pressures": [{"pressure": 1, "gas": 1}])").find("pressures[0].gas") == 0);
  CHECK(error_with(R"("pressures": [{"pressure": "high"}])").find("pressures[0].pressure") == 0);
  CHECK(error_with(R"("pressures": [{"pressure": 1, "unit": "bar"}])").find("unit") !=
        std::string::npos);
}

TEST_CASE("a scene that goes on has the volume at which its gas had its pressure") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  scene.masses = {1, 1, 1, 1};
  scene.surface = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  scene.pressures = {{.pressure = 1000, .gas = true}};
  auto cloth = Cloth::create(build_model(scene).value(), {});
  REQUIRE(cloth.value().step(0.01));
  const SceneDescription present = present_scene(scene, cloth.value());
  CHECK(present.pressures[0].volume == doctest::Approx(1. / 6));
  CHECK(cloth.value().pressures()[0].volume > 0.168);
}

TEST_CASE("a material survives writing and reading to the last bit") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  scene.masses = {1, 1, 1, 1};
  scene.constraints = {{0, 1, 0.7, ConstraintKind::distance, 1.0 / 3},
                       {1, 2, 0.9, ConstraintKind::rope, 1e-7},
                       {2, 3, 0.9, ConstraintKind::rope}};
  scene.bending = {{{0, 1, 2, kNoIndex}, {1, -2.0 / 3, -1.0 / 3, 0}, 0, 1e-9},
                   {{3, 0, 1, 2}, {1, -1, 1.0 / 3, -1.0 / 3}, 1.0 / 7, 3e5}};
  scene.damping = {1.0 / 3, 0, 4e-5};
  scene.air = {{{0, 1, 2}, {3, 2, 1}}, 1.3, 1.0 / 7, 0.1, {1e-300, -2, 1.0 / 3}};
  const auto again = parse_scene(scene_text(scene));
  REQUIRE_MESSAGE(again, again.error());
  check_same(scene, again.value().description);
}

TEST_CASE("triangles of fabric survive writing and reading to the last bit") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  scene.masses = {1, 1, 1, 1};
  scene.membrane = {{{0, 1, 2}, {{{0, 0}, {1.0 / 3, 0}, {0, 1}}}, 4000, 3000, 1.0 / 7},
                    {{3, 2, 1}, {{{0, 0}, {-1, 0}, {0, -1}}}, 0, 0, 60, ConstraintKind::rope}};
  const auto again = parse_scene(scene_text(scene));
  REQUIRE_MESSAGE(again, again.error());
  const auto& membrane = again.value().description.membrane;
  REQUIRE(membrane.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(membrane[i].particles == scene.membrane[i].particles);
    CHECK(membrane[i].rest == scene.membrane[i].rest);
    CHECK(membrane[i].warp == scene.membrane[i].warp);
    CHECK(membrane[i].weft == scene.membrane[i].weft);
    CHECK(membrane[i].shear == scene.membrane[i].shear);
    CHECK(membrane[i].kind == scene.membrane[i].kind);
  }
  const std::string corners = R"("membrane": [{"particles": [0,1,1], "rest": )";
  CHECK(error_with(R"("membrane": [{"particles": [0,1]}])") ==
        "membrane[0]: the key 'rest' is missing");
  CHECK(error_with(corners + "[[0,0],[1,0]]}]") ==
        "membrane[0].rest: expected three corners, not a nested array");
  CHECK(error_with(corners + "[[0,0],[1,0],[0]]}]") ==
        "membrane[0].rest[2]: expected [along warp, along weft], not [0]");
  CHECK(error_with(corners + R"([[0,0],[1,0],[0,1]], "kind": "string"}])") ==
        R"(membrane[0].kind: expected "distance" or "rope", not "string")");
}

TEST_CASE("faces survive writing and reading, and those that cannot be are refused") {
  const auto [scene, mesh, bodies, moves] = scenes::make_scene("hang", {.size = 4}).value();
  const auto again = parse_scene(scene_text(scene, {}, particle_faces(mesh)));
  REQUIRE(again);
  CHECK(again.value().faces == mesh.faces);
  CHECK(error_with(R"("faces": [[0,1]])") ==
        "faces[0]: expected three particles or more, not [0,1]");
  CHECK(error_with(R"("faces": [[0,1,2]])") == "faces[0][2]: there is no particle 2");
  CHECK(error_with(R"("faces": [[0,1,"a"]])").starts_with("faces[0][2]: expected"));
}

TEST_CASE("bodies survive writing and reading, and move as they are told") {
  SceneDescription scene;
  scene.positions = {{0, 1, 0}};
  scene.masses = {1};
  scene.friction = 0.45;
  const std::vector<SceneBody> bodies{{.shape = Plane{{0, 2, 0}, -0.5}, .friction = 0.1},
                                      {.shape = Capsule{{0, 0, 0}, {0, 1, 0}, 0.2, 0.1},
                                       .position = {1, 2, 3},
                                       .thickness = 0.002,
                                       .move = PinMove{.times = {0, 2},
                                                       .translations = {{0, 0, 0}, {4, 0, 0}},
                                                       .rotations = {{0, 0, 0}, {0, 0, 0.5}},
                                                       .about = {1, 2, 3}}},
                                      {.shape = box({1, 2, 3})},
                                      {.shape = Ball{{0, 1, 0}, 0.25}, .rotation = {0, 1, 0.5}}};
  const std::string text = scene_text(scene, {}, {}, bodies);
  const auto read = parse_scene(text);
  REQUIRE_MESSAGE(read, (read ? "" : read.error()));
  CHECK(read.value().description.friction == 0.45);
  REQUIRE(read.value().bodies.size() == 4);
  CHECK(scene_text(read.value().description, {}, {}, read.value().bodies) == text);
  CHECK(read.value().bodies[3].rotation.z == 0.5);  // to the last bit
  const Pose pose = pose_at(read.value().bodies[1], 1);
  CHECK(pose.position.x == 3);
  CHECK(pose.rotation.z == doctest::Approx(std::sin(0.125)));
  CHECK(pose_at(present_bodies(read.value().bodies, 1)[1], 0).position.x == 3);
}

TEST_CASE("self-contact survives writing and reading, and is refused by key and value") {
  SceneDescription scene;
  scene.positions = {{0, 1, 0}};
  scene.masses = {1};
  CHECK(scene_text(scene).find("self_contact") == std::string::npos);
  scene.self_contact = {.on = true, .thickness = 1. / 3000, .friction = 0.1};
  CHECK(parse_scene(scene_text(scene)).value().description.self_contact == scene.self_contact);
  scene.self_contact.on = false;
  CHECK(parse_scene(scene_text(scene)).value().description.self_contact == scene.self_contact);
  scene.self_contact.untangle = true;
  CHECK(parse_scene(scene_text(scene)).value().description.self_contact == scene.self_contact);
  const std::string start = R"({"positions": [[0,0,0]], "masses": [1], "self_contact": )";
  CHECK(parse_scene(start + "{}}").value().description.self_contact == SelfContact{.on = true});
  CHECK(error_with(R"("self_contact": {"on": 1})") ==
        "self_contact.on: expected true or false, not 1");
  CHECK(error_with(R"("self_contact": {"gap": 1})").starts_with("self_contact: unknown key"));
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

TEST_CASE("an error repeats no more than the beginning of what the parser read last") {
  const std::string error = error_of("{\"" + std::string(5000, 'a'));
  CHECK(error.find("last read: '\"" + std::string(39, 'a') + "...'") != std::string::npos);
  CHECK(error.size() < 250);
  CHECK(error_of("\"'; expected " + std::string(5000, 'a')).size() < 250);
}

TEST_CASE("the surface is that of the faces unless it is given") {
  const std::string start = R"({"positions": [[0,0,0],[1,0,0],[1,0,1],[0,0,1]], "total_mass": 1)";
  const auto surface_of = [&](const std::string& more) {
    return parse_scene(start + more + "}").value().description.surface;
  };
  using Surface = std::vector<std::array<std::uint32_t, 3>>;
  CHECK(surface_of("") == Surface{});
  CHECK(surface_of(R"(, "faces": [[0,1,2,3]])") == Surface{{0, 1, 2}, {0, 2, 3}});
  CHECK(surface_of(R"(, "faces": [[0,1,2,3]], "surface": [[1,2,3]])") == Surface{{1, 2, 3}});
  CHECK(surface_of(R"(, "faces": [[0,1,2,3]], "surface": [])") == Surface{});
  const auto faces = parse_scene(start + R"(, "faces": [[0,1,2,3]], "surface": []})").value();
  CHECK(parse_scene(scene_text(faces.description, {}, faces.faces)).value().description.surface ==
        Surface{});
  CHECK(error_with(R"("surface": [[0,1]])") == "surface[0]: expected [a, b, c], not [0,1]");
}

TEST_CASE("errors of bodies name their place") {
  const auto error_of = [](const std::string& bodies) {
    const auto read =
        parse_scene(R"({"positions": [[0, 0, 0]], "masses": [1], "bodies": )" + bodies + "}");
    return read ? std::string() : read.error();
  };
  CHECK(error_of(R"([{"shape": "cone"}])") ==
        R"(bodies[0].shape: expected plane, sphere, capsule, box, hull or mesh, not "cone")");
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

TEST_CASE("seams survive writing and reading to the last bit") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  scene.masses = {1, 1, 1};
  scene.seams = {{0, 1, 1.0 / 3, 0.7}, {1, 2}};
  const auto read = parse_scene(scene_text(scene));
  REQUIRE_MESSAGE(read, read.error());
  const std::vector<Seam>& seams = read.value().description.seams;
  REQUIRE(seams.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(seams[i].a == scene.seams[i].a);
    CHECK(seams[i].b == scene.seams[i].b);
    CHECK(seams[i].time == scene.seams[i].time);
    CHECK(seams[i].max_force == scene.seams[i].max_force);
  }
  CHECK(error_with(R"("seams": [{"a": 0}])") == "seams[0]: the key 'b' is missing");
}

TEST_CASE("anchors survive writing and reading to the last bit; what is infinite is null") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.masses = {1, 1, 1};
  scene.anchors = {{2, {1.0 / 3, 0, -1e-9}, {}, 1.0 / 7, 0, 0},
                   {0, {}, {0, 0.6, 0.8}, kInfinity, 1e-3, kInfinity},
                   {1, {1, 2, 3}, {1, 0, 0}, 0, 0, 0.3}};
  const std::string text = scene_text(scene);
  const auto again = parse_scene(text);
  REQUIRE_MESSAGE(again, again.error());
  check_same(scene, again.value().description);
  CHECK(text.find("\"max_distance\":null") != std::string::npos);
  CHECK(error_with(R"("anchors": [{"particle": 0}])") == "anchors[0]: the key 'point' is missing");
  CHECK(error_with(R"("anchors": [{"particle": 0, "point": [0,0,0], "max_distance": "far"}])") ==
        R"(anchors[0].max_distance: expected a number, not "far")");
  CHECK(error_with(R"("anchors": [{"reach": 1}])") == "anchors[0]: unknown key 'reach'");
}

TEST_CASE("of a material everything but particles, weights and compliance may be left out") {
  const auto scene = parse_scene(R"({"positions": [[0,0,0],[3,4,0],[1,1,1]], "total_mass": 3,
      "bending": [{"weights": [1,-2,1], "compliance": 2, "particles": [0,1,2]}],
      "damping": {"bending": 3}, "air": {"wind": [1,2,3]}})");
  REQUIRE_MESSAGE(scene, scene.error());
  const SceneDescription& read = scene.value().description;
  REQUIRE(read.bending.size() == 1);
  CHECK(read.bending[0].particles == std::array<std::uint32_t, 4>{0, 1, 2, kNoIndex});
  CHECK(read.bending[0].rest == 0);
  CHECK(read.damping.bending == 3);
  CHECK(read.damping.stretch == 0);
  CHECK(read.air.density == 1.2);
  CHECK(read.air.wind.z == 3);
}

TEST_CASE("errors of a material name their place") {
  CHECK(error_with(R"("constraints": [[0,1,1,"rope","soft"]])") ==
        R"(constraints[0][4]: expected a number, not "soft")");
  CHECK(error_with(R"("bending": [{"particles": [0,1]}])") ==
        "bending[0]: the key 'weights' is missing");
  CHECK(error_with(R"("bending": [{"particles": [0,1], "weights": [0,1], "compliance": 1}])") ==
        "bending[0].particles: expected three or four, not [0,1]");
  CHECK(error_with(R"("bending": [{"particles": [0,1,2], "weights": [0,1], "compliance": 1}])") ==
        "bending[0].weights: expected as many as particles, not [0,1]");
  CHECK(error_with(R"("bending": [{"stiffness": 1}])") == "bending[0]: unknown key 'stiffness'");
  CHECK(error_with(R"("damping": {"stretch": "x"})") ==
        R"(damping.stretch: expected a number, not "x")");
  CHECK(error_with(R"("damping": {"strain": 1})") == "damping: unknown key 'strain'");
  CHECK(error_with(R"("damping": 1)") == "damping: expected an object, not 1");
  CHECK(error_with(R"("damping": {"stretch": 1, "stretch": 2})") ==
        "the key 'stretch' is given twice");
  CHECK(error_with(R"("air": {"triangles": [[0,1]]})") ==
        "air.triangles[0]: expected [a, b, c], not [0,1]");
  CHECK(error_with(R"("air": {"wind": 3})") == "air.wind: expected [x, y, z], not 3");
}

TEST_CASE("a run goes on from its last state as if it had not stopped") {
  const auto scene = scenes::make("sphere_drop", {.size = 5});
  REQUIRE(scene);
  const auto run_from = [](const SceneDescription& start) {
    auto model = build_model(start);
    REQUIRE(model);
    auto cloth = Cloth::create(model.value(), paper_settings());
    REQUIRE(cloth);
    for (int frame = 0; frame < 20; ++frame) REQUIRE(cloth.value().step(0.01));
    return std::move(cloth.value());
  };
  Cloth cloth = run_from(scene.value());
  const auto again = parse_scene(scene_text(present_scene(scene.value(), cloth)));
  REQUIRE(again);
  for (int frame = 0; frame < 20; ++frame) REQUIRE(cloth.step(0.01));
  CHECK(run_from(again.value().description).state_hash() == cloth.state_hash());
}

TEST_CASE("what is left out is measured, shared or usual") {
  const auto scene = parse_scene(R"({"positions": [[0,0,0],[3,4,0]], "total_mass": 3,
                                     "constraints": [[0,1]]})");
  REQUIRE(scene);
  CHECK(scene.value().description.masses == std::vector<double>{1.5, 1.5});
  CHECK(scene.value().description.constraints[0].rest_length == 5);
  CHECK(scene.value().description.constraints[0].kind == ConstraintKind::distance);
  CHECK(same(scene.value().description.gravity, Vec3{0, -10, 0}));
  CHECK(scene.value().description.velocities.empty());
}

TEST_CASE("a null rest length is measured too") {
  const auto scene = parse_scene(R"({"positions": [[0,0,0],[3,4,0]], "total_mass": 3,
                                     "constraints": [[0,1,null,"rope"]]})");
  REQUIRE(scene);
  CHECK(same(scene.value().description.constraints[0], Constraint{0, 1, 5, ConstraintKind::rope}));
}

TEST_CASE("errors name the place in the file") {
  CHECK(error_with(R"("velocities": [[0,0,0],[0,"x",0]])") ==
        R"(velocities[1][1]: expected a number, not "x")");
  CHECK(error_with(R"("gravity": [0,0])") == "gravity: expected [x, y, z], not [0,0]");
  CHECK(error_with(R"("fixed": 1)") == "fixed: expected an array, not 1");
  CHECK(error_with(R"("fixed": [0, -1])") == "fixed[1]: expected a particle number, not -1");
  CHECK(error_with(R"("fixed": [4294967296])") ==
        "fixed[0]: expected a particle number, not 4294967296");
  CHECK(error_with(R"("fixed": [4294967295])") ==
        "fixed[0]: expected a particle number, not 4294967295");
  CHECK(error_with(R"("fixed": [0.5])") == "fixed[0]: expected a particle number, not 0.5");
  CHECK(error_with(R"("constraints": [[0,1],[1]])") ==
        "constraints[1]: expected [a, b, rest length, kind, compliance, strength], not [1]");
  CHECK(
      error_with(R"("constraints": [[0,1,1,"rope",0,0,0]])") ==
      R"(constraints[0]: expected [a, b, rest length, kind, compliance, strength], not [0,1,1,"rope",0,0,0])");
  CHECK(error_with(R"("constraints": [[0,1,-2]])") ==
        "constraints[0][2]: expected a length above 0, not -2");
  CHECK(error_with(R"("constraints": [[0,1,1,"spring"]])") ==
        R"(constraints[0][3]: expected "distance" or "rope", not "spring")");
  CHECK(error_with(R"("constraints": [[0,9]])") == "constraints[0]: there is no particle 9");
}

TEST_CASE("of what is long an error shows the beginning") {
  const std::string digits(1000, '1');
  CHECK(error_with("\"gravity\": \"" + digits + '"') ==
        "gravity: expected [x, y, z], not \"" + digits.substr(0, 39) + "...");
}

TEST_CASE("of what nests an error says no more, however deep it is") {
  CHECK(error_with(R"("gravity": [[0], {}])") == "gravity: expected [x, y, z], not a nested array");
  CHECK(error_with(R"("fixed": {"a": {}})") == "fixed: expected an array, not a nested object");
  const std::size_t depth = 200'000;
  CHECK(error_with("\"fixed\": [" + std::string(depth, '[') + std::string(depth, ']') + ']') ==
        "fixed[0]: expected a particle number, not a nested array");
}

TEST_CASE("what is long is not cut within a character") {
  CHECK(error_with("\"fixed\": \"" + std::string(38, 'a') + "\u00e9\u00e9\"") ==
        "fixed: expected an array, not \"" + std::string(38, 'a') + "...");
}

TEST_CASE("unknown, missing and contradicting keys are refused") {
  CHECK(error_with(R"("colour": 1)") == "unknown key 'colour'");
  CHECK(error_with(R"("two\nlines": 1)") == R"(unknown key 'two\nlines')");
  CHECK(error_with(R"("masses": [1,1])") == "expected one of the keys 'masses' and 'total_mass'");
  CHECK(error_with(R"("fixed": [0], "gravity": [0,0,0], "fixed": [1])") ==
        "the key 'fixed' is given twice");
  CHECK(error_with(R"("positions": [])") == "the key 'positions' is given twice");
  CHECK(error_of("{}") == "the key 'positions' is missing");
  CHECK(error_of("[]") == "expected an object with the key 'positions'");
  CHECK(error_of(R"({"positions": [], "total_mass": 0})") ==
        "total_mass: expected a mass above 0, not 0");
}

TEST_CASE("a number beyond all doubles is refused with its line") {
  CHECK(error_of("{\"gravity\": [0, 0, 0],\n\"positions\": [[0, -1e999, 0]]}") ==
        "line 2: number overflow parsing '-1e999'");
}

TEST_CASE("text that is not JSON is refused in one line") {
  for (const std::string text : {"", "{", "weft", R"({"positions": [[1e999,0,0]]})", "\xff\xfe"}) {
    CAPTURE(text);
    const std::string error = error_of(text);
    CHECK_FALSE(error.empty());
    CHECK(error.find('\n') == std::string::npos);
  }
}

// ------------------------------------------------------------------------------------------ moves

void check_same(const PinMove& a, const PinMove& b) {
  CHECK(a.particles == b.particles);
  CHECK(a.times == b.times);
  CHECK(same(a.translations, b.translations));
  CHECK(same(a.rotations, b.rotations));
  CHECK(same(a.about, b.about));
  CHECK(same(a.from, b.from));
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

TEST_CASE("a file's errors name the file") {
  const TemporaryFolder folder;
  CHECK(read_scene_file(folder.file("none.json")).error() ==
        "cannot read '" + folder.file("none.json") + "': No such file or directory");
  const std::string bad = folder.write("bad.json", "{}");
  CHECK(read_scene_file(bad).error() == bad + ": the key 'positions' is missing");
  CHECK_FALSE(read_scene_file(folder.file("")));
}

}  // namespace
}  // namespace weft::tools
