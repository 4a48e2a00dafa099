
#include <doctest/doctest.h>

#include <limits>

#include "tests/tools/scene_texts.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

using namespace test::scene_texts;

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
