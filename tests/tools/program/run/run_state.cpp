/// Runs that go on from the state of another one: --save and --resume.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/tools/run_program.h"
#include "tests/tools/running_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/run/run_state.h"

namespace weft::tools {
namespace {

TEST_CASE("a run that was killed goes on to the same bits") {
  for (const std::string scene :
       {"mannequin --size 30 --sleep on", "hang_sphere --size 12 --solver yarn",
        "corners --size 9 --solver direct", "corners --size 9 --backend reference"}) {
    CAPTURE(scene);
    const TemporaryFolder folder;
    const std::string state = folder.file("state.weft");
    std::vector<std::string> arguments{"run"};
    for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
      end = scene.find(' ', at);
      arguments.push_back(scene.substr(at, end - at));
    }
    for (const char* more : {"--steps", "100000000", "--save"}) arguments.emplace_back(more);
    arguments.push_back(state);
    const Running running(folder, arguments);
    wait_for([&] { return std::filesystem::exists(state); });
    running.kill_at_once();
    const auto killed = read_run_state(state);
    REQUIRE(killed);
    const std::string run = scene + " --steps " + std::to_string(killed.value().frame + 7);
    const auto resumed =
        report_of(folder, run + " --resume " + state + " --save " + folder.file("end.weft"));
    const auto whole = report_of(folder, run);
    CHECK(resumed["state_hash"] == whole["state_hash"]);
    CHECK(resumed["frames"] == 7);
    const auto end = read_run_state(folder.file("end.weft"));
    REQUIRE(end);
    CHECK(end.value().frame == killed.value().frame + 7);
  }
}

TEST_CASE(
    "a run whose cloth has torn goes on to the same bits, and so do recordings of both parts") {
  const TemporaryFolder folder;
  const std::string run =
                        "hang --size 12 --material cotton --self-contact on --dt 1/60 --strength ",
                    state = folder.file("state.weft"), again = folder.file("again.weft");
  const auto recorded = [&](const std::string& name) { return " --record " + folder.file(name); };
  const auto whole = report_of(folder, run + "0.8 --steps 60" + recorded("whole.weft"));
  CHECK(whole["torn"] > 0);
  const auto first = report_of(folder, run + "0.8 --steps 40 --save " + state);
  CHECK(first["torn"] > 0);
  report_of(folder, run + "0.8 --steps 50 --resume " + state + " --save " + again);
  const auto last =
      report_of(folder, run + "0.8 --steps 60 --resume " + again + recorded("rest.weft"));
  CHECK(last["state_hash"] == whole["state_hash"]);
  CHECK(last["frames"] == 10);
  for (const char* name : {"whole.weft", "rest.weft"})
    CHECK(run_program(folder, "replay " + folder.file(name)).exit_code == 0);
  const Outcome refused = run_program(folder, "run " + run + "0.9 --steps 60 --resume " + state);
  CHECK(refused.exit_code != 0);
  CHECK(refused.err.find("state: is of another model") != std::string::npos);
}

TEST_CASE("cloth that has torn and grows is resumed to the same bits") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json"), state = folder.file("state.weft");
  const Outcome written =
      run_program(folder, "scene hang --size 12 --material cotton --strength 0.8 --out " + scene);
  REQUIRE(written.exit_code == 0);
  std::string text = folder.read("scene.json");
  text.insert(text.rfind('}'), R"(, "rest_scale": {"times": [0, 1], "scales": [1, 0.9]})");
  const std::string run = folder.write("growing.json", text) + " --dt 1/60 --steps ";
  const auto whole = report_of(folder, run + "60");
  CHECK(report_of(folder, run + "40 --save " + state)["torn"] > 0);
  CHECK(report_of(folder, run + "60 --resume " + state)["state_hash"] == whole["state_hash"]);
}

TEST_CASE(
    "a run with a body that moves by itself goes on to the same bits, and is replayed to them") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", R"({"total_mass": 0.4, "fixed": [0, 1, 2, 3],
        "positions": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [0.5, -0.05, 0.5]],
        "constraints": [[0, 4, null, "distance", 1e-3], [1, 4], [2, 4], [3, 4]],
        "bodies": [{"shape": "plane", "offset": -5},
                   {"shape": "box", "size": [0.9, 1.6, 1], "position": [0.52, 0.9, 0.5],
                    "mass": 0.3, "velocity": [0, -0.5, 0], "spin": [0.4, 3, 0]}]})");
  const std::string run = scene + " --dt 1/60 --steps ", state = folder.file("state.weft");
  const auto whole = report_of(folder, run + "30 --record " + folder.file("whole.weft"));
  CHECK(whole["body_contacts"] == 1);
  REQUIRE(whole["free_bodies"].size() == 1);
  CHECK(whole["free_bodies"][0]["body"] == 1);
  CHECK(whole["free_bodies"][0]["position"][1] < 0.9);
  report_of(folder, run + "10 --save " + state);
  const auto resumed =
      report_of(folder, run + "30 --resume " + state + " --record " + folder.file("rest.weft"));
  CHECK(resumed["state_hash"] == whole["state_hash"]);
  CHECK(resumed["free_bodies"] == whole["free_bodies"]);
  for (const char* name : {"whole.weft", "rest.weft"})
    CHECK(run_program(folder, "replay " + folder.file(name)).exit_code == 0);
}

TEST_CASE("a body that moves by itself goes on from a scene that a run has written") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", R"({"positions": [[9, 0, 0]],
        "masses": [1], "bodies": [{"shape": "box", "size": [0.1, 0.2, 0.4], "density": 1000,
        "position": [0, 1, 0], "rotation": [3, 0.5, 0], "velocity": [1, 2, 0], "spin": [9, 3, 1]}]})");
  const std::string at = " --dt 1/60 --steps ";
  const auto whole = report_of(folder, scene + at + "30");
  report_of(folder, scene + at + "10 --out " + folder.file("later.json"));
  const auto rest = report_of(folder, folder.file("later.json") + at + "20");
  for (const char* key : {"position", "rotation", "centre"}) {
    CAPTURE(key);
    const auto& expected = whole["free_bodies"][0][key];
    const auto& found = rest["free_bodies"][0][key];
    const double sign =
        key[0] == 'r' && found[3].get<double>() * expected[3].get<double>() < 0 ? -1 : 1;
    for (std::size_t i = 0; i < expected.size(); ++i)
      CHECK(sign * found[i].get<double>() ==
            doctest::Approx(expected[i].get<double>()).epsilon(1e-6));
  }
}

TEST_CASE("pins that move, and a run that is resumed twice, come to the same bits") {
  const TemporaryFolder folder;
  const std::string scene =
      folder.write("scene.json", R"({"positions": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "masses": [1, 1, 1], "fixed": [0], "constraints": [[0, 1, 1], [1, 2, 1]],
        "moves": [{"particles": [0], "times": [0, 1], "translations": [[0, 0, 0], [0, 1, 0]]}],
        "bodies": [{"shape": "sphere", "centre": [1, -0.5, 0], "radius": 0.3}]})");
  const std::string run = scene + " --dt 1/60 --steps ", state = folder.file("state.weft");
  report_of(folder, run + "20 --save " + state);
  report_of(folder, run + "40 --resume " + state + " --save " + state);
  const auto last = report_of(folder, run + "60 --resume " + state);
  CHECK(last["state_hash"] == report_of(folder, run + "60")["state_hash"]);
  CHECK(last["frames"] == 20);
}

TEST_CASE("states that a run cannot go on from are refused in one line") {
  const TemporaryFolder folder;
  const std::string state = folder.file("state.weft"), run = "run hang --size 6 --steps ";
  REQUIRE(run_program(folder, run + "5 --save " + state).exit_code == 0);
  const auto refusal = [&](const std::string& arguments) {
    const Outcome outcome = run_program(folder, arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    return outcome.err;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(refusal("run hang --size 7 --resume " + state), "state: is of another model");
  has(refusal(run + "9 --dt 1/60 --resume " + state), "is of frames of 0.01 s, and --dt is");
  has(refusal(run + "5 --resume " + state), "is of frame 5, and --steps 5 asks for none after it");
  has(refusal(run + "9 --resume " + folder.file("none")), "--resume: ");
  has(refusal(run + "9 --resume " + state + " --out " + folder.file("motion.pc2")),
      "needs all frames, and --resume leaves out the first 5");
  has(refusal(run + "9 --save " + folder.file("no/such/folder")), "--save: cannot write");
  has(refusal(run + "9 --save " + state + " --json " + state), "is named twice");
  std::string bytes = folder.read("state.weft");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  has(refusal(run + "9 --resume " + folder.write("damaged", bytes)), "is damaged");
  has(refusal(run + "9 --resume " + folder.write("text", "not a state")), "is not one of weft's");
}

}  // namespace
}  // namespace weft::tools
