/// The program as its users run it: what it prints where, and how it exits.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "temporary_folder.h"
#include "tools/scene_file.h"
#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/scenes.h"

extern char** environ;

namespace weft::tools {
namespace {

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

Outcome run_program(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string command = std::string(WEFT_PROGRAM) + " " + arguments + " >" +
                              folder.file("stdout") + " 2>" + folder.file("stderr");
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  const Outcome outcome{WEXITSTATUS(status), folder.read("stdout"), folder.read("stderr")};
  std::filesystem::remove(folder.file("stdout"));
  std::filesystem::remove(folder.file("stderr"));
  return outcome;
}

TEST_CASE("with --json - stdout is JSON alone, with every key of the contract") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "run hang --size 5 --steps 4 --json -");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  const auto json = nlohmann::json::parse(outcome.out);
  std::istringstream keys(
      "scene particles constraints solver scheme backend isa threads dt steps substeps "
      "tolerance status ms_per_frame max_ms_per_frame real_time_factor max_strain mean_max_strain "
      "rms_strain iterations_per_step direction_updates_per_step visits corrections "
      "ns_per_constraint_iteration energy_start energy_end energy_gain lowest_y "
      "state_hash bytes_per_particle stages peak_rss_mb pin_work");
  for (std::string key; keys >> key;) {
    CAPTURE(key);
    CHECK(json.contains(key));
    CHECK_FALSE(json[key].is_null());
  }
  CHECK(json["scene"] == "hang");
  CHECK(json["particles"] == 25);
  CHECK(json["steps"] == 4);
  CHECK(json["status"] == "converged");
  CHECK(json["max_strain"] <= 0.01);
  CHECK(json["state_hash"].get<std::string>().size() == 16);
  CHECK(json["stages"].contains("solve_positions"));
}

TEST_CASE("the table tells no time without its strain") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "run hang --size 5 --steps 4");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" ms ") != std::string::npos) CHECK(line.find("strain") != std::string::npos);
  }
}

TEST_CASE("every built-in scene runs with its default size and reaches its tolerance") {
  const TemporaryFolder folder;
  for (const scenes::BuiltIn& scene : scenes::list()) {
    CAPTURE(scene.name);
    const Outcome outcome =
        run_program(folder, "run " + std::string(scene.name) + " --steps 3 --json -");
    CHECK(outcome.exit_code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["max_strain"] <= 0.01);
  }
}

TEST_CASE("what is refused exits with 2 and one line that names it") {
  const TemporaryFolder folder;
  const struct {
    std::string arguments;
    std::string named;
  } kRefused[] = {
      {"", "a verb is missing: run, scene, paper, hard or precision"},
      {"''", "a verb is missing: run, scene, paper, hard or precision"},
      {"weave", "'weave' is not a verb: run, scene, paper, hard or precision"},
      {"weave --size 3", "'weave' is not a verb"},
      {"--colour red", "--colour"},
      {"run", "SCENE"},
      {"run curtain", "'curtain'"},
      {"run none.obj", "'none.obj'"},
      {"run none.json", "'none.json'"},
      {"run hang --size x", "--size: 'x' is not a whole number"},
      {"run hang --size ''", "--size: '' is not a whole number"},
      {"run hang --size 0x10", "--size: '0x10' is not a whole number"},
      {"run hang --json ''", "--json: '' names nothing"},
      {"paper --quick --out ''", "--out: '' names nothing"},
      {"run sphere_drop --slack ''", "--slack: '' is not a number"},
      {"run hang --size 1", "size"},
      {"run hang --steps 0", "--steps: 0"},
      {"run hang --dt -1", "--dt: -1"},
      {"run hang --dt nan", "--dt: 'nan' is not a number"},
      {"run hang --repeat 0", "--repeat: 0"},
      {"run hang --tolerance 0%", "--tolerance: '0%'"},
      {"run hang --iterations -1", "iterations"},
      {"run hang --substeps 0", "--substeps: '0'"},
      {"run hang --substeps 1.5", "--substeps: '1.5'"},
      {"run hang --substeps 9999999999", "--substeps: '9999999999'"},
      {"run hang --skip maybe", "--skip: 'maybe'"},
      {"run hang --solver magic", "--solver: 'magic'"},
      {"run hang --pin top", "--pin"},
      {"run hang --slack 0.1", "--slack"},
      {"run hang --ropes", "--ropes: only for .obj meshes and cape, not for 'hang'"},
      {"run chain --diagonals", "--diagonals: only for built-in grids, not for 'chain'"},
      {"run cape --diagonals", "--diagonals: only for built-in grids, not for 'cape'"},
      {"run none.obj --diagonals", "--diagonals: only for built-in grids, not for 'none.obj'"},
      {"run none.json --diagonals", "--diagonals: only for built-in grids, not for 'none.json'"},
      {"run hang --out a.txt", "'a.txt'"},
      {"run hang --out ''", "--out: '' names nothing"},
      {"run hang --out missing/a.obj", "'missing/a.obj'"},
      {"run hang --json missing/a.json", "'missing/a.json'"},
      {"run hang --out a.json --json ./a.json", "'a.json'"},
      {"run hang --out a.json --json $PWD/a.json", "'a.json'"},
      {"run hang --colour red", "--colour"},
      {"scene hang --out a.obj", "'a.obj'"},
      {"precision --scene curtain", "'curtain'"},
      {"precision --scene hang_sphere", "--scene hang_sphere"},
      {"precision --scene corners --size 8", "size"},
      {"precision --threads 0", "--threads"},
      {"precision --json missing/a.json", "'missing/a.json'"},
  };
  for (const auto& refused : kRefused) {
    CAPTURE(refused.arguments);
    const Outcome outcome = run_program(folder, refused.arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("weft: "));
    CHECK(outcome.err.find(refused.named) != std::string::npos);
    CHECK(std::ranges::count(outcome.err, '\n') == 1);
  }
}

TEST_CASE("numbers are decimal, whatever they begin with") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "run hang --size 010 --steps +02 --json -");
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["particles"] == 100);
  CHECK(json["steps"] == 2);
}

TEST_CASE("streams that are closed or full cost no file, and only stdout an error") {
  const TemporaryFolder folder;
  const auto exit_code = [](const std::string& arguments) {
    const int status = std::system((std::string(WEFT_PROGRAM) + " " + arguments).c_str());
    REQUIRE(WIFEXITED(status));
    return WEXITSTATUS(status);
  };
  const std::string run = "run hang --size 5 --steps 2 --out " + folder.file("a.pc2");
  CHECK(exit_code(run + " <&- >&- 2>&-") == 2);
  constexpr std::size_t kHeader = 32, kSample = 25 * 3 * sizeof(float);
  CHECK(folder.read("a.pc2").size() == kHeader + 3 * kSample);
  CHECK(exit_code(run + " --json " + folder.file("a.json") + " >/dev/null 2>&-") == 0);
  CHECK(nlohmann::json::parse(folder.read("a.json"))["steps"] == 2);
  for (const char* nowhere : {"2>&-", "2>/dev/full"}) {
    CHECK(exit_code(std::string("run nowhere.obj ") + nowhere) == 2);
  }
}

TEST_CASE("a reader that goes away leaves no part of a file") {
  const TemporaryFolder folder;
  const std::string command = std::string(WEFT_PROGRAM) + " hard --quick --case chain --json " +
                              folder.file("a.json") + " 2>&1 | true";
  CHECK(std::system(command.c_str()) == 0);
  for (const auto& left : std::filesystem::directory_iterator(folder.file(""))) {
    CHECK(left.path().filename() == "a.json");  // of a run that was not told
  }
}

TEST_CASE("the version is that of the project") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "--version");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out == "weft " WEFT_VERSION "\n");
}

TEST_CASE("every solver and scheme can be asked for, and the report names it") {
  const TemporaryFolder folder;
  using nlohmann::json;
  const struct {
    std::string arguments;
    json reported;
  } calls[] = {
      {"--solver gauss_seidel --scheme paper --backend reference --threads 1 --substeps 1",
       {{"solver", "gauss_seidel"},
        {"solver_used", "gauss_seidel"},
        {"scheme", "paper"},
        {"backend", "reference"},
        {"threads", 1},
        {"substeps", 1}}},
      {"--solver yarn --substeps 2 --backend simd",
       {{"solver", "yarn"}, {"solver_used", "yarn"}, {"backend", "simd"}, {"substeps", 2}}},
      {"--solver auto --substeps auto", {{"solver", "auto"}, {"scheme", "paper"}}},
      {"--solver direct", {{"solver", "direct"}, {"solver_used", "direct"}}},
      {"--scheme rattle", {{"solver", "auto"}, {"scheme", "rattle"}}},
  };
  for (const auto& call : calls) {
    CAPTURE(call.arguments);
    const Outcome outcome =
        run_program(folder, "run hang --size 4 --steps 2 " + call.arguments + " --json -");
    CHECK(outcome.exit_code == 0);
    const json report = json::parse(outcome.out);
    for (const auto& [key, value] : call.reported.items()) {
      CAPTURE(key);
      CHECK(report[key] == value);
    }
  }
}

TEST_CASE("the report tells which solver auto came to") {
  const TemporaryFolder folder;
  const struct {
    std::string arguments;
    std::string used;
  } kChoices[] = {{"hang --size 4", "yarn"},
                  {"hang --size 4 --iterations 3", "gauss_seidel"},
                  {"chain --end-mass 1e7", "direct"}};
  for (const auto& choice : kChoices) {
    CAPTURE(choice.arguments);
    const std::string arguments = "run " + choice.arguments + " --steps 2";
    const auto json = nlohmann::json::parse(run_program(folder, arguments + " --json -").out);
    CHECK(json["solver"] == "auto");
    CHECK(json["solver_used"] == choice.used);
    const std::string table = run_program(folder, arguments).out;
    CHECK(table.find("solver    auto (" + choice.used + "), scheme") != std::string::npos);
  }
}

TEST_CASE("the direct solver is available") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      folder, "run corners --size 7 --steps 5 --tolerance 1e-6 --solver direct --json -");
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["solver"] == "direct");
  CHECK(json["max_strain"] <= 1e-6);
}

TEST_CASE("substeps are done and reported") {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& arguments, int substeps) {
    const Outcome outcome = run_program(folder, "run hang --size 5 --json - " + arguments);
    REQUIRE(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(outcome.out);
    CHECK(json["substeps"] == substeps);
    return json["state_hash"].get<std::string>();
  };
  const std::string split = hash("--dt 0.02 --steps 10 --substeps 2", 2);
  CHECK(split == hash("--dt 0.01 --steps 20", 1));
}

TEST_CASE("a missed tolerance exits with 3, and the report and the files are written") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(folder,
                  "run hang --size 9 --steps 5 --tolerance 0.001% --max-iterations 2 --solver "
                  "gauss_seidel --out " +
                      folder.file("last.obj") + " --json " + folder.file("report.json"));
  CHECK(outcome.exit_code == 3);
  CHECK(outcome.err.starts_with("weft: the tolerance was missed, first in frame 2: "));
  CHECK(outcome.err.find(": iteration_limit; constraint ") != std::string::npos);
  CHECK(std::ranges::count(outcome.err, '\n') == 1);
  CHECK(nlohmann::json::parse(folder.read("report.json"))["status"] == "iteration_limit");
  CHECK(folder.read("last.obj").starts_with("o cloth\n"));
}

TEST_CASE("a fixed number of iterations is exactly that") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(folder, "run hang --size 6 --steps 5 --iterations 7 --json -");
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["status"] == "fixed_iterations");
  CHECK(json["iterations_per_step"] == 7);
}

TEST_CASE("the way of iterating can be chosen") {
  const TemporaryFolder folder;
  for (const std::string method :
       {"--anticipate off --skip off --directions each", "--anticipate on --skip off",
        "--anticipate products", "--anticipate products --skip off --directions each",
        "--anticipate off --skip on --directions frozen", "--velocity-correction on"}) {
    CAPTURE(method);
    const Outcome outcome = run_program(folder, "run hang --size 6 --steps 10 --json - " + method);
    CHECK(outcome.exit_code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["max_strain"] <= 0.01);
  }
}

nlohmann::json report_of(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome outcome = run_program(folder, "run " + arguments + " --json -");
  REQUIRE(outcome.exit_code == 0);
  return nlohmann::json::parse(outcome.out);
}

TEST_CASE("a tighter tolerance of contacts leaves less of them") {
  const TemporaryFolder folder;
  const std::string run =
      "hang_sphere --size 9 --steps 60 --solver gauss_seidel --contact-tolerance ";
  CHECK(report_of(folder, run + "1e-6")["max_penetration"] <= 1e-6);
  CHECK(report_of(folder, run + "1e-2")["max_penetration"] > 1e-3);
}

TEST_CASE("a tighter tolerance of velocities takes more iterations") {
  const TemporaryFolder folder;
  const auto iterations = [&](const std::string& tolerance) {
    return report_of(folder,
                     "hang --size 9 --steps 5 --solver gauss_seidel --velocity-correction "
                     "on --velocity-tolerance " +
                         tolerance)["velocity_iterations_per_step"]
        .get<double>();
  };
  CHECK(iterations("1e-5") > 2 * iterations("1e-2"));
}

TEST_CASE("limited impulses are more of them") {
  const TemporaryFolder folder;
  const std::string run = "hang --size 5 --steps 5 --tolerance 1e-4 --backend reference ";
  const int unlimited = report_of(folder, run)["corrections"];
  CHECK(report_of(folder, run + "--impulse-limit 1e-5")["corrections"] > 2 * unlimited);
}

TEST_CASE("frozen directions are renewed as often as is asked") {
  const TemporaryFolder folder;
  const auto report = report_of(
      folder, "hang --size 9 --steps 5 --solver gauss_seidel --tolerance 1e-4 --renew-after 1");
  CHECK(report["direction_updates_per_step"] == report["iterations_per_step"]);
}

TEST_CASE("a run may use as many threads as is asked") {
  const TemporaryFolder folder;
  CHECK(report_of(folder, "hang --size 4 --steps 1 --threads 1")["threads"] == 1);
  CHECK(report_of(folder, "hang --size 4 --steps 1 --threads 3")["threads"] == 3);
}

TEST_CASE("methods of Gauss-Seidel are asked of it; what is named has one substep") {
  const TemporaryFolder folder;
  const std::string run = "hang --size 4 --steps 2 --dt 0.1";
  const auto by_products = report_of(folder, run + " --anticipate products");
  CHECK(by_products["solver"] == "gauss_seidel");
  CHECK(by_products["anticipate_products"] == true);
  for (const std::string method : {"--skip on", "--anticipate on", "--directions frozen"}) {
    CAPTURE(method);
    CHECK(report_of(folder, run + ' ' + method)["solver"] == "gauss_seidel");
    CHECK(report_of(folder, run + " --solver yarn " + method)["solver"] == "yarn");
  }
  CHECK(report_of(folder, run)["substeps"] > 1);
  CHECK(report_of(folder, run + " --solver yarn")["substeps"] == 1);
}

TEST_CASE("what cannot anticipate through products says so, in a line") {
  const TemporaryFolder folder;
  for (const std::string arguments :
       {"--anticipate products --backend reference", "--anticipate products --solver yarn"}) {
    CAPTURE(arguments);
    const Outcome outcome = run_program(folder, "run hang --size 4 " + arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find("anticipate_products") != std::string::npos);
  }
  CHECK(run_program(folder, "run hang --size 4 --anticipate some").exit_code == 2);
}

TEST_CASE("options that have no effect beside others do no harm") {
  const TemporaryFolder folder;
  for (const std::string arguments :
       {"--backend reference --isa auto", "--scheme rattle --velocity-correction on",
        "--iterations 0 --tolerance 1%", "--solver gauss_seidel --skip on --max-iterations 1000",
        "--iterations 5 --skip off --directions each", "--iterations 5 --tolerance 1%",
        "--solver yarn --skip off", "--backend reference --isa sse2"}) {
    CAPTURE(arguments);
    CHECK(run_program(folder, "run hang --size 4 --steps 2 " + arguments).exit_code == 0);
  }
}

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
  const std::string whole = hash("hang_sphere --size 7 --steps 20");
  CHECK(hash(start + " --steps 10 --out " + half) != whole);
  CHECK(hash(half + " --steps 10") == whole);
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

TEST_CASE("the folder and the JSON of a study may be one place") {
  const TemporaryFolder folder;
  const std::string json = folder.file("precision.json");
  const Outcome outcome = run_program(folder, "precision --quick --scene hang --size 4 --out " +
                                                  folder.file("") + " --json " + json);
  CHECK(outcome.exit_code == 0);
  CHECK_FALSE(outcome.out.empty());
  CHECK_FALSE(nlohmann::json::parse(folder.read("precision.json"))["points"].empty());
  CHECK(folder.read("points.csv").find("\nhang,4,yarn,") != std::string::npos);
  CHECK(folder.read("precision.md").starts_with("| hang 4², ms per frame |"));
}

TEST_CASE("precision: JSON alone on stdout, points and orders of the contract") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "precision --size 4 --quick --json -");
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  REQUIRE_FALSE(json["points"].empty());
  for (const auto& point : json["points"]) {
    CHECK(point["ms_per_frame"] > 0);
    CHECK(point["max_strain"] > 0);
  }
  CHECK(json["order"]["paper"] > 0.7);
  CHECK(json["order"]["rattle"] > 1.7);
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

TEST_CASE("one of a kind is counted in the singular") {
  const TemporaryFolder folder;
  const std::string scene =
      folder.write("one.json", R"({"positions": [[0,0,0]], "masses": [1], "radii": [1],
                                   "spheres": [0]})");
  const Outcome outcome = run_program(folder, "run " + scene + " --steps 1");
  CHECK(outcome.out.find(": 1 particle, 0 constraints, 1 sphere\n") != std::string::npos);
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\nl 5 3\n";

TEST_CASE("a mesh is pinned, run and saved with its numbering") {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("square.obj", kSquare);
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
  const std::string arguments = "scene " + folder.write("square.obj", kSquare) +
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

TEST_CASE("a mesh of a material is what the options say") {
  const TemporaryFolder folder;
  const std::string square = folder.write("square.obj", kSquare);
  const std::string file = folder.file("scene.json");
  const auto written = [&](const std::string& options) {
    const Outcome outcome =
        run_program(folder, "scene " + square + " --out " + file + ' ' + options);
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
    return read_scene_file(file).value().description;
  };
  const SceneDescription silk = written("--material silk --ropes diagonals --wind 1,-2,3");
  CHECK(silk.constraints.size() == 6);
  CHECK(std::ranges::count(silk.constraints, ConstraintKind::rope, &Constraint::kind) == 2);
  CHECK(silk.air.triangles.size() == 2);
  CHECK(silk.air.wind.y == -2);
  CHECK(silk.damping.bending > 0);
  const SceneDescription own = written("--stretch 100 --density 2 --damping 0.5");
  CHECK(own.masses == std::vector<double>(4, 0.5));
  CHECK(own.constraints[0].compliance == doctest::Approx(2.0 / 100));
  CHECK(own.damping.stretch == 0.5);
  const std::string material =
      folder.write("heavy.json", R"({"density": 8, "warp": 10, "weft": 10, "bending": 1})");
  CHECK(written("--material " + material).masses == std::vector<double>(4, 2));
  CHECK(written("--material " + material + " --density 4").masses == std::vector<double>(4, 1));
  CHECK(written("--ropes all").constraints[0].kind == ConstraintKind::rope);
  CHECK(run_program(folder, "scene cape --size 9 --material wool --out " + file).exit_code == 0);
  const SceneDescription cape = read_scene_file(file).value().description;
  CHECK(cape.bending.size() > 100);
  CHECK(cape.fixed == scenes::make("cape", {.size = 9}).value().fixed);
}

TEST_CASE("options of a material that mean nothing are refused") {
  const TemporaryFolder folder;
  const std::string square = folder.write("square.obj", kSquare);
  const std::string bad = folder.write("bad.json", R"({"weight": 3})");
  const struct {
    std::string options, error;
  } kRefused[] = {
      {square + " --material tweed",
       "--material: material: there is no 'tweed', there are cotton, denim, linen, polyester, "
       "silk, "
       "wool"},
      {square + " --material " + bad, "--material: " + bad + ": unknown key 'weight'"},
      {square + " --shear 3", "--shear: needs --stretch or --material"},
      {square + " --stretch 3", "--stretch: needs --density or --material"},
      {square + " --material silk --bend -1",
       "material.bending: must be finite and at least 0 (-1)"},
      {square + " --material silk --mass 3", "--mass: a material has a density instead"},
      {square + " --wind 1,2,3", "--wind: only cloth of a material feels it"},
      {square + " --material silk --wind 1,2", "--wind: '1,2' is not x,y,z"},
      {square + " --material silk --wind 1,2,3,4", "--wind: '1,2,3,4' is not x,y,z"},
      {square + " --ropes some", "--ropes: 'some' is not one of all, diagonals"},
      {"hang --material silk", "--material: only for .obj meshes and cape, not for 'hang'"},
      {"hang --drag 1", "--drag: only for .obj meshes and cape, not for 'hang'"}};
  for (const auto& [options, error] : kRefused) {
    CAPTURE(options);
    const Outcome outcome = run_program(folder, "run " + options);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find(error) != std::string::npos);
  }
}

TEST_CASE("whoever runs rigid triangles is told what to ask for") {
  const TemporaryFolder folder;
  const std::string triangle = folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string square = folder.write("square.obj", kSquare);
  const auto err = [&](const std::string& options) {
    return run_program(folder, "run --steps 1 " + options).err;
  };
  CHECK(err(triangle) ==
        "weft: triangles of rigid edges lock, so that the cloth hardly folds: ask for --material, "
        "or --ropes all\n");
  CHECK(err(triangle + " --ropes all").empty());
  CHECK(err(square).empty());
}

TEST_CASE("what is asked of a built-in scene is what is made") {
  const TemporaryFolder folder;
  const struct {
    std::string name;
    std::string arguments;
    scenes::Options options;
  } kScenes[] = {{"hang", "--size 4", {.size = 4}},
                 {"corners", "", {.size = 21}},
                 {"sphere_drop", "--size 5 --slack 0.2", {.size = 5, .slack = 0.2}},
                 {"sphere_drop", "--sphere-mass 7", {.sphere_mass = 7}},
                 {"four_pins", "--diagonals --size 5", {.size = 5, .diagonals = true}},
                 {"corners", "--diagonals", {.size = 21, .diagonals = true}},
                 {"cape", "", {.size = 20}},
                 {"cape", "--ropes --size 9", {.size = 9, .ropes = true}},
                 {"cape", "--size 9 --ropes all", {.size = 9, .ropes = true}},
                 {"chain", "--end-mass 9", {.end_mass = 9}}};
  for (const auto& asked : kScenes) {
    CAPTURE(asked.arguments);
    const std::string file = folder.file("scene.json");
    const std::string arguments = "scene " + asked.name + ' ' + asked.arguments + " --out " + file;
    CHECK(run_program(folder, arguments).exit_code == 0);
    CHECK(folder.read("scene.json") == scene_text(scenes::make(asked.name, asked.options).value()));
  }
}

/// The program at work in a process of its own.
class Running {
 public:
  Running(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string out = folder.file("stdout"), err = folder.file("stderr");
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    std::string program = WEFT_PROGRAM;
    std::vector<char*> pointers{program.data()};
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawnattr_t attributes;  // a hangup may be ignored here (nohup), and would be there
    posix_spawnattr_init(&attributes);
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(&usual, SIGHUP);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int failure =
        posix_spawn(&process_, WEFT_PROGRAM, &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    REQUIRE(failure == 0);
  }
  void interrupt() const { send(SIGINT); }
  void send(int signal) const { kill(process_, signal); }
  int exit_code() const {
    int status = 0;
    waitpid(process_, &status, 0);
    REQUIRE(WIFEXITED(status));
    return WEXITSTATUS(status);
  }

 private:
  pid_t process_ = 0;
};

void wait_for(const std::function<bool()>& sight) {
  while (!sight()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

// The terminal sends one signal, its shell another.
TEST_CASE("a run whose terminal is closed ends with its frame too") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const Running running(
      folder, {"run", "hang", "--steps", "100000000", "--out", outputs.file("motion.pc2")});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  running.send(SIGHUP);
  running.send(SIGHUP);
  CHECK(running.exit_code() == 128 + SIGHUP);
  CHECK(folder.read("stderr").find("weft: stops after this frame") == 0);
  const std::string motion = outputs.read("motion.pc2");
  REQUIRE(motion.size() > 32);
  CHECK((motion.size() - 32) % (12 * 400) == 0);
}

TEST_CASE("an interrupted run ends with its frame: whole files, a line, 130") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const std::string motion = outputs.file("motion.pc2"), scene = outputs.file("last.json");
  const std::string report = outputs.file("report.json");
  const Running running(folder, {"run", "hang", "--steps", "100000000", "--out", motion, "--out",
                                 scene, "--json", report});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").find("weft: stops after this frame") == 0);
  REQUIRE_FALSE(outputs.read("report.json").empty());
  const auto frames = nlohmann::json::parse(outputs.read("report.json"))["steps"].get<int>();
  CHECK(folder.read("stderr").find("weft: interrupted in frame " + std::to_string(frames) +
                                   " of 100000000,") != std::string::npos);
  CHECK(outputs.read("motion.pc2").size() ==
        32 + (static_cast<std::size_t>(frames) + 1) * 12 * 400);

  // The last state is that of a run of so many frames.
  const Outcome same = run_program(
      folder, "run hang --steps " + std::to_string(frames) + " --out " + folder.file("same.json"));
  CHECK(same.exit_code == 0);
  CHECK(folder.read("same.json") == outputs.read("last.json"));
}

TEST_CASE("an interrupted repeat leaves the report of a whole run") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const std::string scene = outputs.file("last.json"), report = outputs.file("report.json");
  const Running running(folder, {"run", "hang", "--size", "5", "--steps", "50", "--repeat",
                                 "100000000", "--out", scene, "--json", report});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").find("weft: interrupted in repeat ") != std::string::npos);
  CHECK(nlohmann::json::parse(outputs.read("report.json"))["steps"] == 50);
  const Outcome same =
      run_program(folder, "run hang --size 5 --steps 50 --out " + folder.file("same.json"));
  CHECK(same.exit_code == 0);
  CHECK(folder.read("same.json") == outputs.read("last.json"));
}

TEST_CASE("a second interrupt ends a frame that takes too long, and leaves no file") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const Running running(folder, {"run", "corners", "--size", "301", "--tolerance", "0.0001%",
                                 "--out", outputs.file("last.obj")});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  running.interrupt();
  wait_for([&] { return folder.read("stderr").find("once more") != std::string::npos; });
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").ends_with("weft: interrupted\n"));
  CHECK(outputs.is_empty());
}

}  // namespace
}  // namespace weft::tools
