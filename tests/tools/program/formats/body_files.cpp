#include "tools/program/formats/body_files.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scenes/body_meshes.h"

namespace weft::tools {
namespace {

std::string obj_of(const TriangleMesh& mesh, Vec3 moved) {
  std::string text;
  for (const Vec3 v : mesh.vertices)
    text += fmt::format("v {} {} {}\n", v.x + moved.x, v.y + moved.y, v.z + moved.z);
  for (const auto& [a, b, c] : mesh.triangles)
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

TriangleMesh ball() { return scenes::ball_mesh({.radius = 0.2}, 12); }

/// 11 frames, 1 cm apart along x, below the middle of a sheet of a metre.
void write_frames(const TemporaryFolder& folder) {
  for (int i = 0; i <= 10; ++i)
    folder.write(fmt::format("ball_{}.obj", i), obj_of(ball(), {0.45 + 0.01 * i, -0.22, 0.5}));
}

TEST_CASE("a body of one file is rigid and one-sided") {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  const auto body =
      body_of_files({.names = folder.write("b.obj", obj_of(ball(), {})), .scale = 2}, notes);
  REQUIRE_MESSAGE(body, (body ? "" : body.error()));
  const auto& mesh = std::get<TriangleMesh>(body.value().shape);
  CHECK(mesh.triangles == ball().triangles);
  CHECK(mesh.vertices[0].y == doctest::Approx(-0.4));
  CHECK_FALSE(mesh.two_sided);
  CHECK_FALSE(body.value().vertex_move);
  CHECK(notes.empty());
}

TEST_CASE("frames are in the order of their numbers, linear between") {
  const TemporaryFolder folder;
  write_frames(folder);
  std::vector<std::string> notes;
  const auto body = body_of_files({.names = folder.file("ball_*.obj"), .frame = 0.5}, notes);
  REQUIRE_MESSAGE(body, (body ? "" : body.error()));
  REQUIRE(body.value().vertex_move->times.size() == 11);
  CHECK(body.value().vertex_move->times.back() == 5);
  CHECK(body.value().vertex_move->vertices[10][0].x == doctest::Approx(0.55));
  CHECK(body.value().vertex_move->vertices[2][0].x == doctest::Approx(0.47));
}

TEST_CASE("triangles that are turned differently make it two-sided, those turned inwards a note") {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  TriangleMesh mesh = ball();
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  const auto inwards = body_of_files({.names = folder.write("i.obj", obj_of(mesh, {}))}, notes);
  REQUIRE(inwards);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("inside out") != std::string::npos);
  CHECK(notes[0].find("--turn-bodies") != std::string::npos);
  CHECK_FALSE(std::get<TriangleMesh>(inwards.value().shape).two_sided);
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  const auto mixed = body_of_files({.names = folder.write("m.obj", obj_of(mesh, {}))}, notes);
  REQUIRE(mixed);
  REQUIRE(notes.size() == 2);
  CHECK(notes[1].find("not all turned the same way") != std::string::npos);
  CHECK(std::get<TriangleMesh>(mixed.value().shape).two_sided);
}

TEST_CASE(
    "a mesh that is inside out is told, far from the origin and beside an open one, and turned") {
  const TemporaryFolder folder;
  TriangleMesh mesh = ball();
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  const std::string far = obj_of(mesh, {1e5, -2e5, 3e5});
  const auto count = static_cast<int>(mesh.vertices.size());
  const std::string files[] = {far, far + fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {} {} {}\n",
                                                      count + 1, count + 2, count + 3)};
  for (const std::string& text : files) {
    std::vector<std::string> notes;
    const std::string name = folder.write("far.obj", text);
    REQUIRE(body_of_files({.names = name}, notes));
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("--turn-bodies") != std::string::npos);
    const auto turned = body_of_files({.names = name, .turn = true}, notes);
    REQUIRE(turned);
    REQUIRE(notes.size() == 2);
    CHECK(notes[1].find("are turned") != std::string::npos);
    const auto& [a, b, c] = std::get<TriangleMesh>(turned.value().shape).triangles[0];
    CHECK((a == ball().triangles[0][0] && b == ball().triangles[0][1]));
    CHECK(c == ball().triangles[0][2]);
  }
  std::vector<std::string> notes;
  TriangleMesh hollow = ball();  // a hole in a ball faces inwards, and is right
  const auto first = static_cast<std::uint32_t>(hollow.vertices.size());
  for (const Vec3 v : mesh.vertices) hollow.vertices.push_back({v.x / 2, v.y / 2, v.z / 2});
  for (const auto& [a, b, c] : mesh.triangles)
    hollow.triangles.push_back({a + first, b + first, c + first});
  REQUIRE(body_of_files({.names = folder.write("hollow.obj", obj_of(hollow, {}))}, notes));
  CHECK(notes.empty());
}

TEST_CASE("errors name the option and the file") {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& name, std::optional<double> frame = {}) {
    std::vector<std::string> notes;
    const auto body = body_of_files({.names = folder.file(name), .frame = frame}, notes);
    REQUIRE_FALSE(body);
    return body.error();
  };
  write_frames(folder);
  CHECK(error_of("ball_*.obj").ends_with("needs --body-dt"));
  CHECK(error_of("none_*.obj", 1).starts_with("--body: no file is named like"));
  CHECK(error_of("ball_*_*.obj", 1).find("more than one *") != std::string::npos);
  CHECK(error_of("none.obj").starts_with("--body: cannot read"));
  folder.write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  CHECK(error_of("line.obj").ends_with("line.obj: no face in the file"));
  folder.write("ball_11.obj", obj_of(scenes::ball_mesh({.radius = 0.2}, 16), {}));
  CHECK(error_of("ball_*.obj", 1).find("its faces are not those of") != std::string::npos);
}

TEST_CASE("bodies that stand still may be beside one that moves, and time is for that alone") {
  const TemporaryFolder folder;
  write_frames(folder);
  const std::string still = folder.write("still.obj", obj_of(ball(), {3, 0, 0}));
  const std::string hang = "hang --size 5 --dt 1/60 --body-dt 1/30 --body " + still;
  const auto json =
      report_of(folder, fmt::format("{} --body '{}' --steps 2", hang, folder.file("ball_*.obj")));
  CHECK(json["bodies"] == 2);
  const Outcome outcome = run_program(folder, "run " + hang + " --steps 2");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.err.find("--body-dt: is for a --body with a * in its name") != std::string::npos);
}

TEST_CASE("a sheet falls over a body, which is checked from outside") {
  const TemporaryFolder folder;
  write_frames(folder);
  const std::string around = fmt::format(
      "hang --size 12 --material cotton --dt 1/60 --body '{}' --body-dt 1/30 --thickness 0.002",
      folder.file("ball_*.obj"));
  const auto json = report_of(folder, around + " --steps 30 --check-intersections");
  CHECK(json["bodies"] == 1);
  CHECK(json["body_triangles"] == ball().triangles.size());
  CHECK(json["body_contacts"] > 0);
  CHECK(json["friction_work"] > 0);
  CHECK(json["intersections"] == 0);
  CHECK(json["intersecting"] == 0);
  CHECK(json.contains("contact_failures"));
  CHECK(json.contains("zones"));
  const std::string scene = folder.file("scene.json");
  REQUIRE(run_program(folder, "scene " + around.substr(0, around.find("--dt")) +
                                  around.substr(around.find("--body")) + " --out " + scene)
              .exit_code == 0);
  const auto again = report_of(folder, scene + " --dt 1/60 --steps 30");
  CHECK(again["state_hash"] == json["state_hash"]);
  CHECK_FALSE(again.contains("intersections"));
}

TEST_CASE("what begins in a body crosses it, and the report says so") {
  const TemporaryFolder folder;
  const std::string body = folder.write("b.obj", obj_of(ball(), {0.5, 0, 0.5}));
  const Outcome outcome =
      run_program(folder,
                  "run hang --size 12 --material cotton --dt 1/600 --steps 1 --check-intersections "
                  "--json " +
                      folder.file("report.json") + " --body " + body);
  CHECK(outcome.out.find("\ncrossings ") != std::string::npos);
  CHECK(nlohmann::json::parse(folder.read("report.json"))["intersections"] > 0);
}

}  // namespace
}  // namespace weft::tools
