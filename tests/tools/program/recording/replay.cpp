/// A run as a file: it comes to the same bits again, and what is another one is told.
#include <doctest/doctest.h>
#include <signal.h>

#include <cstdio>
#include <filesystem>
#include <set>
#include <span>

#include "tests/tools/run_program.h"
#include "tests/tools/running_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/recording/replay.h"

namespace weft::tools {
namespace {

/// A run of the program that is recorded.
struct Recorded {
  TemporaryFolder folder;
  std::string file = folder.file("run.weft");
  explicit Recorded(const std::string& run) {
    const Outcome outcome = run_program(folder, "run " + run + " --record " + file);
    REQUIRE(outcome.exit_code == 0);
  }
  Outcome replay(const std::string& options = "") const {
    return run_program(folder, "replay " + file + options);
  }
  Recording read() const {
    auto recording = read_recording(file);
    REQUIRE(recording);
    return recording.value();
  }
  void write(const Recording& recording) const {
    std::string text;
    const auto add = [&](const std::vector<std::byte>& part) {
      text.append(reinterpret_cast<const char*>(part.data()), part.size());
    };
    add(bytes_of(recording.start));
    for (const RecordedStep& step : recording.steps) {
      add(bytes_of(step.calls));
      if (step.result) add(bytes_of(*step.result));
    }
    if (recording.is_finished) add(bytes_of_end());
    folder.write("run.weft", text);
  }
};

bool has(const std::string& text, const std::string& part) {
  CAPTURE(text);
  CAPTURE(part);
  CHECK(text.find(part) != std::string::npos);
  return text.find(part) != std::string::npos;
}

const char* const kMovingScene = R"({"positions": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
  "masses": [1, 1, 1], "fixed": [0], "constraints": [[0, 1, 1], [1, 2, 1]],
  "moves": [{"particles": [0], "times": [0, 1], "translations": [[0, 0, 0], [0, 1, 0]]}],
  "bodies": [{"shape": "sphere", "centre": [1, -0.5, 0], "radius": 0.3,
              "moves": {"times": [0, 0.1], "translations": [[0, 0, 0], [0, 0.1, 0]]}},
             {"shape": "mesh", "vertices": [[0, -2, 0], [3, -2, 0], [0, -2, 3]],
              "triangles": [[0, 2, 1]], "two_sided": true,
              "vertex_moves": {"times": [0, 0.1], "vertices":
                [[[0, -2, 0], [3, -2, 0], [0, -2, 3]], [[0, -1.9, 0], [3, -2, 0], [0, -2, 3]]]}}]})";

TEST_CASE(
    "a recorded run comes to the same bits: pins, bodies, meshes and layers, by every solver") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", kMovingScene);
  for (const std::string& run :
       {scene + " --steps 12", std::string("mannequin --size 20 --dt 1/60 --steps 4"),
        std::string("fold --size 20 --steps 5"),
        std::string("hang --size 9 --solver yarn --steps 9"),
        std::string("sphere_drop --size 9 --steps 9 --backend reference"),
        std::string("hang --size 9 --solver gauss_seidel --anticipate products --steps 9")}) {
    CAPTURE(run);
    const Recorded recorded(run);
    const Outcome replayed = recorded.replay();
    CHECK(replayed.exit_code == 0);
    CHECK(replayed.err.empty());
    const auto steps = recorded.read().steps;
    has(replayed.out, "replayed  " + std::to_string(steps.size()) + " steps to the same bits\n");
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016llx",
                  static_cast<unsigned long long>(steps.back().result->hash));
    has(replayed.out, hash);
    CHECK(report_of(folder, run)["state_hash"] == hash);
  }
}

TEST_CASE("a recording has the first of repeated runs, and says after which frame a run goes on") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", kMovingScene);
  const Recorded recorded(scene + " --steps 12 --repeat 2");
  const Recording whole = recorded.read();
  CHECK(whole.is_finished);
  REQUIRE(whole.steps.size() == 12);

  const std::string state = folder.file("state.weft");
  REQUIRE(run_program(folder, "run " + scene + " --steps 5 --save " + state).exit_code == 0);
  const Recorded resumed(scene + " --steps 12 --resume " + state);
  const Recording rest = resumed.read();
  REQUIRE(rest.steps.size() == 7);
  CHECK(rest.steps.back().result->hash == whole.steps.back().result->hash);
  has(resumed.replay().out, "recorded  after frame 5, ");
}

TEST_CASE("the first step that differs is named") {
  const Recorded recorded("hang --size 5 --steps 9");
  Recording changed = recorded.read();
  changed.steps[6].result->hash ^= 1;
  changed.steps[7].result->hash ^= 1;
  recorded.write(changed);
  const Outcome replayed = recorded.replay();
  CHECK(replayed.exit_code == 1);
  has(replayed.out, "replayed  6 steps to the same bits\n");
  CHECK(replayed.err.starts_with("weft: step 7 is the first that differs: recorded "));
  changed.start.hash ^= 1;
  recorded.write(changed);
  has(recorded.replay().err, "weft: the state before the first step differs: recorded ");
}

TEST_CASE("calls of a step that are others differ there, or are refused there") {
  const TemporaryFolder folder;
  const Recorded recorded(folder.write("scene.json", kMovingScene) + " --steps 9");
  Recording changed = recorded.read();
  RecordedCalls& calls = changed.steps[3].calls;
  REQUIRE(!calls.state.empty());  // a pin and two bodies move
  calls.state.clear();
  recorded.write(changed);
  has(recorded.replay().err, "weft: step 4 is the first that differs");
  calls.state.push_back({1u << 30, 0, {}});
  recorded.write(changed);
  const Outcome refused = recorded.replay();
  CHECK(refused.exit_code == 2);
  has(refused.err, "step 4: patch: is of other bytes (1073741824)");
}

TEST_CASE("a step that was not done, for want of memory, is passed over") {
  const Recorded recorded("hang --size 5 --steps 5");
  Recording changed = recorded.read();
  changed.steps.insert(changed.steps.begin() + 2, RecordedStep{{0.01, {}, {}}, {}});
  recorded.write(changed);
  const Outcome replayed = recorded.replay();
  CHECK(replayed.exit_code == 0);
  has(replayed.out, "hang, weft " WEFT_VERSION);
  has(replayed.out, "replayed  5 steps to the same bits\n");
}

TEST_CASE("another version and other instructions are told") {
  const Recorded recorded("hang --size 9 --steps 30");
  Recording old = recorded.read();
  old.start.version = "0.1.0";
  recorded.write(old);
  const Outcome replayed = recorded.replay();
  CHECK(replayed.exit_code == 0);
  CHECK(replayed.err == "weft: recorded by weft 0.1.0, and this is " WEFT_VERSION
                        ": steps may differ\n");
  old.start.state[9] ^= std::byte{1};
  recorded.write(old);
  const Outcome refused = recorded.replay();
  CHECK(refused.exit_code == 2);
  has(refused.err, "(recorded by weft 0.1.0, and this is " WEFT_VERSION ")\n");

  old = recorded.read();
  const Isa isa = old.start.settings.isa;
  old.start.settings.isa = isa == Isa::neon ? Isa::avx2 : Isa::neon;  // this machine lacks it
  old.start.version = WEFT_VERSION;
  old.start.state[9] ^= std::byte{1};
  recorded.write(old);
  const Outcome elsewhere = recorded.replay();
  CHECK(elsewhere.exit_code == 0);
  has(elsewhere.err, std::string("weft: recorded on ") + std::string(name(old.start.settings.isa)) +
                         ", and this runs on " + std::string(name(isa)) +
                         ": steps should not differ\n");
}

TEST_CASE("sse2 rounds otherwise: the first step that differs is named") {
  const TemporaryFolder folder;
  for (const char* isa : {"sse2", "avx2"}) {
    const std::string run = "run chain --size 3 --steps 1 --isa ";
    if (run_program(folder, run + isa).exit_code != 0) return;  // this machine or library lacks it
  }
  const Recorded recorded("hang --size 9 --solver gauss_seidel --steps 30 --isa avx2");
  const Outcome replayed = recorded.replay(" --isa sse2 --threads 1");
  CHECK(replayed.exit_code == 1);
  has(replayed.err, "weft: recorded on avx2, and this runs on sse2: steps differ, since sse2");
  has(replayed.err, " is the first that differs: recorded ");
}

TEST_CASE("each byte that is another one is told, and its step") {
  const Recorded recorded("chain --size 3 --steps 3");
  const std::string bytes = recorded.folder.read("run.weft");
  REQUIRE(parse_recording(std::as_bytes(std::span(bytes))));
  std::set<std::string> told;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    const auto parsed = parse_recording(std::as_bytes(std::span(damaged)));
    CAPTURE(i);
    CHECK_FALSE(parsed);
    if (!parsed) told.insert(parsed.error().substr(0, 20));
  }
  for (const char* step : {"is damaged in step 1", "is damaged in step 2", "is damaged in step 3"})
    CHECK(told.contains(step));
  std::string damaged = bytes;
  damaged[bytes.size() - 60] = static_cast<char>(damaged[bytes.size() - 60] ^ 1);
  recorded.folder.write("run.weft", damaged);
  const Outcome refused = recorded.replay();
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find('\n') == refused.err.size() - 1);
  has(refused.err, "run.weft': is damaged in step 3");
}

TEST_CASE("a recording that is cut off anywhere is replayed as far as it goes, and says so") {
  const Recorded recorded("chain --size 3 --steps 3");
  const std::string bytes = recorded.folder.read("run.weft");
  std::size_t most = 0;
  bool any_within = false;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const auto cut = parse_recording(std::as_bytes(std::span(bytes.data(), size)));
    if (!cut) continue;  // within the start
    CHECK_FALSE(cut.value().is_finished);
    CHECK(cut.value().steps.size() >= most);
    most = cut.value().steps.size();
    any_within = any_within || (most > 0 && !cut.value().steps.back().result);
  }
  CHECK(most == 3);
  CHECK(any_within);

  Recording within = recorded.read();
  within.is_finished = false;
  within.steps.back().result.reset();
  recorded.write(within);
  const Outcome replayed = recorded.replay();
  CHECK(replayed.exit_code == 0);
  has(replayed.out, "end       missing: the program was killed, or the file is cut off\n");
  has(replayed.out, "replayed  2 steps to the same bits\n");
  has(replayed.err, "weft: the program ended within step 3; here that comes to ");
}

TEST_CASE("a run that is killed leaves a recording of what it did") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.weft");
  Running running(folder, {"run", "hang", "--size", "5", "--steps", "100000000", "--record", file});
  const auto steps = [&] {
    const auto recording = read_recording(file);
    return recording ? recording.value().steps.size() : 0;
  };
  wait_for([&] { return std::filesystem::exists(file) && steps() > 3; });
  running.kill_at_once();
  const Outcome replayed = run_program(folder, "replay " + file);
  CHECK(replayed.exit_code == 0);
  has(replayed.out, "end       missing");
}

TEST_CASE("what is no recording is refused in one line") {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& arguments) {
    const Outcome outcome = run_program(folder, arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    return outcome.err;
  };
  has(refusal("replay " + folder.file("none")), "cannot read '");
  has(refusal("replay " + folder.write("empty", "")), "empty': is not a recording of weft's");
  has(refusal("replay " + folder.write("text", std::string(999, 'x'))), "is not a recording");
  has(refusal("replay"), "FILE is required");
  has(refusal("run hang --steps 1 --record " + folder.file("no/such/folder")),
      "--record: path: cannot be written (");
  has(refusal("run hang --steps 1 --record a --save ./a"), "is named twice");
  const Recorded recorded("hang --size 4 --steps 1");
  has(refusal("replay " + recorded.file + " --isa x87"), "--isa: 'x87' is not one of");
}

TEST_CASE("a run that is refused leaves the recording that was there, another run replaces it") {
  const Recorded recorded("hang --size 4 --steps 3");
  const auto run = [&](const std::string& options) {
    return run_program(recorded.folder,
                       "run hang --size 4 --steps 1 --record " + recorded.file + options);
  };
  CHECK(run(" --out " + recorded.folder.file("no/such/folder/a.obj")).exit_code == 2);
  CHECK(run(" --resume " + recorded.folder.write("state.json", "{}")).exit_code == 2);
  has(recorded.replay().out, "replayed  3 steps to the same bits");
  CHECK(run("").exit_code == 0);
  has(recorded.replay().out, "replayed  1 step to the same bits");
}

}  // namespace
}  // namespace weft::tools
