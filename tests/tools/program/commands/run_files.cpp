/// The files that the program reads and writes.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"
#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

TEST_CASE("a scene can be written, run, saved and run on") {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& arguments) {
    const Outcome outcome = run_program(folder, "run " + arguments + " --json -");
    REQUIRE(outcome.exit_code == 0);
    return nlohmann::json::parse(outcome.out)["state_hash"].get<std::string>();
  };
  const std::string start = folder.file("start.json");
  const std::string half = folder.file("half.json");
  CHECK(run_program(folder, "scene hang_sphere --size 7 --out " + start).exit_code == 0);
  const std::string whole = hash("hang_sphere --size 7 --solver yarn --steps 20");
  CHECK(hash(start + " --solver yarn --steps 10 --out " + half) != whole);
  CHECK(hash(half + " --solver yarn --steps 10") == whole);
}

/// hang, whose pins turn by a quarter and go up; all times are exact in binary.
std::string moved_scene(const TemporaryFolder& folder) {
  const SceneDescription scene = scenes::make("hang", {.size = 7}).value();
  return folder.write("moved.json", scene_text(scene, {{.particles = scene.fixed,
                                                        .times = {0, 0.125, 0.5},
                                                        .translations = {{}, {}, {0, 0.25, 0}},
                                                        .rotations = {{}, {}, {0, 1.5, 0}},
                                                        .about = {0, 0, 0.5}}}));
}

TEST_CASE("pins of a file move, and go on where a saved run does") {
  const TemporaryFolder folder;
  const std::string start = moved_scene(folder);
  const auto run_from = [&](const std::string& scene, int steps, const std::string& last) {
    return report_of(folder, scene +
                                 " --dt 0.015625 --solver direct --tolerance 1e-10 --substeps 1 "
                                 "--steps " +
                                 std::to_string(steps) + " --out " + folder.file(last));
  };
  const auto positions = [&](const std::string& file) {
    return read_scene_file(folder.file(file)).value().description.positions;
  };
  const auto whole = run_from(start, 40, "whole.json");
  CHECK(whole["pin_work"] > 0.5);
  CHECK(whole["energy_gain"] < 1e-3);
  const std::vector<Vec3> expected = positions("whole.json");
  for (const int first : {4, 8, 19, 35}) {  // before, at and within the motion, and after it
    CAPTURE(first);
    const auto begun = run_from(start, first, "half.json");
    const auto rest = run_from(folder.file("half.json"), 40 - first, "last.json");
    const std::vector<Vec3> actual = positions("last.json");
    double most = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const Vec3 a = actual[i], b = expected[i];
      const double apart = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
      if (i < 7) CHECK(apart == 0);  // pins
      most = std::max(most, apart);
    }
    CHECK(most < 1e-12);  // a sheet that begins in another place is solved in another order
    const double work = begun["pin_work"].get<double>() + rest["pin_work"].get<double>();
    CHECK(work == doctest::Approx(whole["pin_work"].get<double>()).epsilon(1e-6));
  }
}

TEST_CASE("a scene is written with its moves") {
  const TemporaryFolder folder;
  const std::string start = moved_scene(folder), copy = folder.file("copy.json");
  CHECK(run_program(folder, "scene " + start + " --out " + copy).exit_code == 0);
  CHECK(folder.read("copy.json") == folder.read("moved.json"));
}

TEST_CASE("a step that was taken back is no sample of the motion") {
  const TemporaryFolder folder;
  const std::string motion = folder.file("motion.pc2");
  const Outcome outcome = run_program(folder, "run hang --size 3 --dt 1e200 --out " + motion);
  CHECK(outcome.exit_code == 3);
  constexpr std::uintmax_t kHeader = 32, kSample = 9 * 12;
  CHECK(std::filesystem::file_size(motion) == kHeader + kSample);
}

TEST_CASE("names of files are any bytes, JSON is UTF-8") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("b\xff.json");
  CHECK(run_program(folder, "scene hang --size 3 --out " + scene).exit_code == 0);
  const Outcome outcome = run_program(folder, "run " + scene + " --steps 2 --json -");
  CHECK(outcome.exit_code == 0);
  CHECK(nlohmann::json::parse(outcome.out)["frames"] == 2);
}

TEST_CASE("endings of files may be in capital letters") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("SCENE.JSON");
  CHECK(run_program(folder, "scene hang --size 3 --out " + scene).exit_code == 0);
  const std::string outputs = " --out " + folder.file("LAST.OBJ") + " --out " +
                              folder.file("MOTION.Pc2") + " --out " + folder.file("LAST.Json");
  CHECK(run_program(folder, "run " + scene + " --steps 2" + outputs).exit_code == 0);
  CHECK(folder.read("MOTION.Pc2").starts_with("POINTCACHE2"));
  CHECK(folder.read("LAST.Json").starts_with("{"));
  CHECK(run_program(folder, "run " + folder.file("LAST.OBJ") + " --steps 2").exit_code == 0);
}

const std::string kSquareMesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\nl 5 3\n";

TEST_CASE("a mesh is pinned, run and saved with its numbering") {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("square.obj", kSquareMesh);
  const Outcome outcome =
      run_program(folder, "run " + mesh + " --pin y'>'0.9 --ropes --steps 3 --json - --out " +
                              folder.file("last.obj") + " --out " + folder.file("motion.pc2"));
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["particles"] == 4);
  CHECK(json["constraints"] == 3 + 2);  // without the edge between two pins, with two ropes
  const std::string last = folder.read("last.obj");
  CHECK(last.find("\nv 1 1 0\nv 0 1 0\n") != std::string::npos);
  CHECK(last.find("\nv 0 0 0\n") == std::string::npos);
  CHECK(last.ends_with("f 1 2 3 4\nl 5 3\n"));
  CHECK(folder.read("motion.pc2").size() == 32 + 4 * 5 * 12);
}

TEST_CASE("a file a frame is written where the name has a number in it") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      folder, "run hang --size 4 --steps 3 --out " + folder.file("f_%03d.obj") + " --out " +
                  folder.file("s%d.json") + " --out " + folder.file("last.obj"));
  CHECK(outcome.exit_code == 0);
  CHECK(folder.read("f_000.obj").find("\nv 1 0 1\n") != std::string::npos);
  CHECK(folder.read("f_003.obj") == folder.read("last.obj"));
  CHECK(folder.read("f_002.obj") != folder.read("last.obj"));
  CHECK_FALSE(std::filesystem::exists(folder.file("f_004.obj")));
  CHECK(read_scene_file(folder.file("s2.json")));
  const Outcome refused = run_program(folder, "run hang --out " + folder.file("no/f_%d.obj"));
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("no/f_0.obj") != std::string::npos);
}

TEST_CASE("a mesh that was written as a scene keeps its faces") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json"), last = folder.file("last.obj");
  CHECK(run_program(folder, "scene hang --size 3 --out " + scene).exit_code == 0);
  CHECK(run_program(folder, "run " + scene + " --steps 2 --out " + last).exit_code == 0);
  CHECK(folder.read("last.obj").ends_with("f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n"));
  const std::string square = folder.write("square.obj",
                                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\n"
                                          "f 1 2 3 4\nl 5 6\n");
  CHECK(run_program(folder, "scene " + square + " --out " + scene).exit_code == 0);
  CHECK(run_program(folder, "run " + scene + " --steps 2 --out " + last).exit_code == 0);
  CHECK(folder.read("last.obj").ends_with("f 1 2 3 4\nl 2 5\n"));
}

TEST_CASE("a cape is saved with its faces") {
  const TemporaryFolder folder;
  const std::string last = folder.file("last.obj");
  CHECK(run_program(folder, "run cape --size 9 --steps 3 --out " + last).exit_code == 0);
  std::string faces;
  for (const scenes::Face& face : scenes::irregular_mesh(9).faces) {
    faces += 'f';
    for (const std::uint32_t corner : face) faces += ' ' + std::to_string(corner + 1);
    faces += '\n';
  }
  CHECK(folder.read("last.obj").ends_with('\n' + faces));
}

TEST_CASE("what is asked of a mesh is what is read") {
  const TemporaryFolder folder;
  const std::string arguments = "scene " + folder.write("square.obj", kSquareMesh) +
                                " --pin y'>'0.9 --mass 6 --scale 0.5 --ropes --out " +
                                folder.file("scene.json");
  CHECK(run_program(folder, arguments).exit_code == 0);
  const auto read = read_scene_file(folder.file("scene.json"));
  REQUIRE(read);
  const SceneDescription& scene = read.value().description;
  CHECK(scene.fixed == std::vector<std::uint32_t>{2, 3});
  CHECK(scene.masses == std::vector<double>(4, 1.5));
  CHECK(scene.positions[2].x == 0.5);
  CHECK(scene.positions[2].y == 0.5);
  const auto is_rope = [](const Constraint& c) { return c.kind == ConstraintKind::rope; };
  CHECK(std::ranges::count_if(scene.constraints, is_rope) == 2);
}

}  // namespace
}  // namespace weft::tools
