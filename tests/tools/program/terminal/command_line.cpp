/// What the program prints where, and how it exits.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"

namespace weft::tools {
namespace {

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

TEST_CASE("what is refused exits with 2 and one line that names it") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/zero", folder.file("zero.json"));
  const struct {
    std::string arguments;
    std::string named;
  } kRefused[] = {
      {"", "a verb is missing: run, scene, view, paper, hard, precision or forms"},
      {"''", "a verb is missing: run, scene, view, paper, hard, precision or forms"},
      {"weave", "'weave' is not a verb: run, scene, view, paper, hard, precision or forms"},
      {"weave --size 3", "'weave' is not a verb"},
      {"--colour red", "--colour"},
      {"run", "SCENE"},
      {"run curtains", "'curtains'"},
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
      {"run hang --dt -1", "--dt: '-1'"},
      {"run hang --dt nan", "--dt: 'nan' is not a time"},
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
      {"run chain --ropes",
       "--ropes: only for .obj meshes and built-in scenes but chain, not for 'chain'"},
      {"run chain --diagonals", "--diagonals: only for built-in scenes but chain, not for 'chain'"},
      {"run none.obj --diagonals",
       "--diagonals: only for built-in scenes but chain, not for 'none.obj'"},
      {"run none.json --diagonals",
       "--diagonals: only for built-in scenes but chain, not for 'none.json'"},
      {"run hang --out a.txt", "'a.txt'"},
      {"run hang --out ''", "--out: '' names nothing"},
      {"run hang --out missing/a.obj", "'missing/a.obj'"},
      {"run hang --json missing/a.json", "'missing/a.json'"},
      {"run hang --out a.json --json ./a.json", "'a.json'"},
      {"run hang --out a.json --json $PWD/a.json", "'a.json'"},
      {"run hang --colour red --shade 1 blue", "weft: not expected: --colour red --shade 1 blue"},
      {"run " + folder.file("zero.json"), "it is a device, not a file"},
      {"scene hang --out a.obj", "'a.obj'"},
      {"precision --scene curtains", "'curtains'"},
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

TEST_CASE("one of a kind is counted in the singular") {
  const TemporaryFolder folder;
  const std::string scene =
      folder.write("one.json", R"({"positions": [[0,0,0]], "masses": [1], "radii": [1],
                                   "spheres": [0]})");
  const Outcome outcome = run_program(folder, "run " + scene + " --steps 1");
  CHECK(outcome.out.find(": 1 particle, 0 constraints, 1 sphere\n") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools
