/// What the program prints where, and how it exits.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scenes/scenes.h"

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

/// A line that continues the one before is joined to it by a space, since a term may be broken
/// where figures are long.
std::vector<std::string> rows_of(const std::string& table) {
  std::vector<std::string> rows;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("          ")) {
      REQUIRE_FALSE(rows.empty());
      rows.back() += ' ' + line.substr(line.find_first_not_of(' '));
    } else {
      rows.push_back(line);
    }
  }
  return rows;
}

bool fits_a_terminal(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    CHECK(line.size() <= 80);
    if (line.size() > 80) return false;
  }
  return true;
}

TEST_CASE("the table tells no time without its strain, in 80 columns") {
  const TemporaryFolder folder;
  for (const char* scene : {"hang --size 5", "mannequin --size 20"}) {
    const Outcome outcome = run_program(folder, std::string("run ") + scene + " --steps 4");
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    CHECK(fits_a_terminal(outcome.out));
    int times = 0;
    for (const std::string& row : rows_of(outcome.out)) {
      const bool is_of_parts = row.find("to find contacts") != std::string::npos;  // of a stage
      if (row.find(" ms ") == std::string::npos || is_of_parts) continue;
      ++times;
      CHECK((row.find("strain") != std::string::npos ||
             row.find("error of the law") != std::string::npos));
    }
    CHECK(times == 2);
  }
}

TEST_CASE("help begins with examples, all of which run, and is no wider than a terminal") {
  const TemporaryFolder folder;
  const Outcome help = run_program(folder, "--help");
  CHECK(help.exit_code == 0);
  CHECK(fits_a_terminal(help.out));
  folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  std::istringstream lines(help.out);
  int examples = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  weft ")) continue;
    ++examples;
    CAPTURE(line);
    const std::string command = line.substr(7, line.find("  ", 7) - 7);
    const bool runs = command.starts_with("run ");
    const Outcome example =
        run_program(folder, command + (runs ? " --steps 1" : ""), folder.file(""));
    CHECK(example.exit_code == 0);
  }
  CHECK(examples >= 6);
  for (const char* verb : {"run", "scene", "view", "precision", "hard", "forms", "paper"}) {
    const Outcome of_verb = run_program(folder, std::string(verb) + " --help");
    CHECK(of_verb.exit_code == 0);
    CHECK(fits_a_terminal(of_verb.out));
  }
}

TEST_CASE("every built-in scene has a line in the list of scenes") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "scenes");
  CHECK(outcome.exit_code == 0);
  CHECK(fits_a_terminal(outcome.out));
  for (const scenes::BuiltIn& scene : scenes::list()) {
    CAPTURE(scene.name);
    const std::string name = "\n  " + std::string(scene.name) + " ";
    CHECK(outcome.out.find(name) != std::string::npos);
    CHECK(outcome.out.find(scene.summary) != std::string::npos);
  }
}

/// As bash, if the words are typed and the tabulator after them.
std::string completed(const TemporaryFolder& folder, const std::string& words) {
  const std::string script =
      "source <(" WEFT_PROGRAM " completion); COMP_WORDS=(" + words +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _weft; echo \"${COMPREPLY[*]}\"";
  const std::string command = "bash -c '" + script + "' >" + folder.file("completed");
  REQUIRE(std::system(command.c_str()) == 0);
  return folder.read("completed");
}

TEST_CASE("bash completes verbs, scenes, options and their values") {
  const TemporaryFolder folder;
  CHECK(completed(folder, "weft sc") == "scenes scene\n");
  CHECK(completed(folder, "weft run ta") == "table\n");
  CHECK(completed(folder, "weft run hang --tol") == "--tolerance\n");
  CHECK(completed(folder, "weft run hang --material si") == "silk\n");
  CHECK(completed(folder, "weft run hang --out x") == "\n");
  CHECK(completed(folder, "weft view x") == "\n");
}

TEST_CASE("what is refused exits with 2 and one line that names it") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/zero", folder.file("zero.json"));
  const struct {
    std::string arguments;
    std::string named;
  } kRefused[] = {
      {"",
       "a verb is missing: run, replay, scenes, scene, view, paper, hard, precision, forms or "
       "completion"},
      {"''",
       "a verb is missing: run, replay, scenes, scene, view, paper, hard, precision, forms or "
       "completion"},
      {"weave",
       "'weave' is not a verb: run, replay, scenes, scene, view, paper, hard, precision, forms or "
       "completion"},
      {"weave --size 3", "'weave' is not a verb"},
      {"--colour red --shade 1", "weft: not expected: --colour red --shade 1"},
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
      {"scene hang --oud a.json --sise 3", "weft: not expected: --oud a.json --sise 3"},
      {"scene hang", "weft: --out is required"},
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
