/// Events of a scene file, and anchors that move: read, written and run.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"

namespace weft::tools {
namespace {

/// A pin, a particle that hangs from it, one that is sewn to a pin, and one that an anchor holds.
SceneDescription hanging_scene() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  scene.masses = {1, 1, 1, 1, 1};
  scene.fixed = {0, 2};
  scene.constraints = {{0, 1, 1}};
  scene.seams = {{2, 3, 0.5}};
  scene.anchors = {{.particle = 4, .point = {2, 0, 0}, .normal = {0, 1, 0}}};
  return scene;
}

const std::vector<SceneEvent> kEvents{
    {.time = -1.0 / 3, .wind = Vec3{0.1, 0, 0}},
    {.time = 0.5,
     .release = {0},
     .release_seams = {0},
     .anchors = {{0, {std::numeric_limits<double>::infinity(), false}}}},
    {.time = 0.5, .fix = {1}, .close_seams = {0}, .gravity = Vec3{0, -1.0 / 7, 0}},
    {.time = 2, .release = {1}, .anchors = {{0, {1.0 / 9, true}}}, .anchor_scale = 0.1}};

TEST_CASE("events and moves of anchors survive writing and reading to the last bit") {
  const SceneDescription scene = hanging_scene();
  const std::vector<PinMove> moves{{.anchors = {0},
                                    .times = {0, 0.1},
                                    .translations = {{0, 1.0 / 3, 0}, {1, 0, 0}},
                                    .rotations = {{0, 0, 0.7}, {0, 0, 0}},
                                    .from = {{2, 1.0 / 7, 0}}}};
  const RestScale rest_scale{{-1, 1.0 / 3}, {1, 1.0 / 7}};
  const std::string text = scene_text(scene, moves, {}, {}, kEvents, rest_scale);
  const auto again = parse_scene(text);
  REQUIRE(again);
  const auto& [description, its_moves, faces, bodies, events, its_scale] = again.value();
  CHECK(scene_text(description, its_moves, faces, bodies, events, its_scale) == text);
  CHECK(its_scale.times == rest_scale.times);
  CHECK(its_scale.scales == rest_scale.scales);
  REQUIRE(events.size() == 4);
  CHECK(events[0].time == -1.0 / 3);
  CHECK(events[1].release == std::vector{0u});
  CHECK(std::isinf(events[1].anchors[0].limit.max_distance));
  CHECK_FALSE(events[1].anchors[0].limit.backstop);
  CHECK(events[2].fix == std::vector{1u});
  CHECK(events[2].gravity->y == -1.0 / 7);
  CHECK(events[3].anchors[0].limit.max_distance == 1.0 / 9);
  CHECK(events[3].anchor_scale == 0.1);
  CHECK(its_moves[0].anchors == std::vector{0u});
  CHECK(its_moves[0].from[0].y == 1.0 / 7);
}

std::string event_error(const std::string& more) {
  std::string text = scene_text(hanging_scene());
  text.erase(text.rfind('}'));
  const auto scene = parse_scene(text + ", " + more + "}");
  REQUIRE_FALSE(scene);
  return scene.error();
}

TEST_CASE("errors of events and of anchors that move name their place") {
  const auto with = [](const std::string& events) { return event_error(R"("events": )" + events); };
  CHECK(with("{}") == "events: expected an array, not {}");
  CHECK(with("[{}]") == "events[0]: the key 'time' is missing");
  CHECK(with(R"([{"time": 0, "unpin": [0]}])") == "events[0]: unknown key 'unpin'");
  CHECK(with(R"([{"time": 1}, {"time": 0.5}])") == "events[1].time: expected 1 or later, not 0.5");
  CHECK(with(R"([{"time": 1, "release": [1]}])") ==
        "events[0].release[0]: particle 1 is not fixed");
  CHECK(with(R"([{"time": 1, "release": [0]}, {"time": 2, "release": [2, 0]}])") ==
        "events[1].release[1]: particle 0 is not fixed");
  CHECK(with(R"([{"time": 1, "fix": [0]}])") == "events[0].fix[0]: particle 0 is fixed already");
  CHECK(with(R"([{"time": 1, "fix": [9]}])") == "events[0].fix[0]: particle 9 is not there");
  CHECK(with(R"([{"time": 1, "fix": [4]}])") == "events[0].fix[0]: particle 4 has an anchor");
  CHECK(with(R"([{"time": 1, "release_seams": [1]}])") ==
        "events[0].release_seams[0]: there is no seam 1");
  CHECK(with(R"([{"time": 1, "anchors": [{"anchor": 1, "max_distance": 0}]}])") ==
        "events[0].anchors[0]: there is no anchor 1");
  CHECK(with(R"([{"time": 1, "anchors": [{"anchor": 0, "max_distance": -1}]}])") ==
        "events[0].anchors[0].max_distance: expected a distance of at least 0, or null, not -1");
  CHECK(with(R"([{"time": 1, "anchors": [{"anchor": 0, "anchor": 1, "max_distance": 1}]}])") ==
        "the key 'anchor' is given twice");
  const auto scale = [](const std::string& scales) {
    return event_error(R"("rest_scale": {"times": [0, 1], "scales": )" + scales + "}");
  };
  CHECK(scale("[1]") == "rest_scale.scales: expected as many as times, 2, not 1");
  CHECK(scale("[1, 0]") == "rest_scale.scales[1]: expected a scale above 0, not 0");
  const auto move = [](const std::string& who) {
    return event_error(R"("moves": [{"times": [0], "translations": [[0,0,0]], )" + who + "}]");
  };
  CHECK(move(R"("anchors": [1])") == "moves[0].anchors[0]: there is no anchor 1");
  CHECK(move(R"("anchors": [0, 0])") == "moves[0].anchors[1]: anchor 0 is moved twice");
  CHECK(move(R"("anchors": [0], "particles": [0])") == "moves[0]: unknown key 'particles'");
}

/// The scene, with a pin that moves up at 2 m/s and is released, with the seam and the anchor,
/// which moves to the side at 1 m/s, at 0.5 s. All times are exact in binary.
std::string falling_scene(const TemporaryFolder& folder) {
  const std::vector<PinMove> moves{
      {.particles = {0}, .times = {0, 2}, .translations = {{0, 0, 0}, {0, 4, 0}}},
      {.anchors = {0}, .times = {0, 2}, .translations = {{0, 0, 0}, {2, 0, 0}}}};
  return folder.write("falling.json",
                      scene_text(hanging_scene(), moves, {}, {},
                                 {{.time = 0.5,
                                   .release = {0},
                                   .release_seams = {0},
                                   .anchors = {{0, {std::numeric_limits<double>::infinity()}}}},
                                  {.time = 0.75, .close_seams = {0}}}));
}

TEST_CASE("what is released at a time falls from then on, by its speed, at any frame rate") {
  for (const int rate : {32, 64, 256}) {
    CAPTURE(rate);
    const TemporaryFolder folder;
    const std::string last = folder.file("last.json");
    report_of(folder, falling_scene(folder) + " --solver small_steps --dt 1/" +
                          std::to_string(rate) + " --steps " + std::to_string(3 * rate / 4) +
                          " --out " + last);
    const auto positions = read_scene_file(last).value().description.positions;
    const double t = 0.25, fallen = 5 * t * t;  // since the release
    CHECK(positions[0].y == doctest::Approx(1 + 2 * t - fallen).epsilon(0.01));
    CHECK(positions[3].y == doctest::Approx(-fallen).epsilon(0.02));
    CHECK(positions[4].x == doctest::Approx(2.5 + t).epsilon(0.01));
    CHECK(positions[4].y == doctest::Approx(-fallen).epsilon(0.02));
  }
}

TEST_CASE("a run that is resumed, replayed or goes on from its last state has the same events") {
  const TemporaryFolder folder;
  const std::string run = falling_scene(folder) + " --solver small_steps --dt 1/64 --steps ";
  const std::string state = folder.file("state.weft"), half = folder.file("half.json");
  const std::string last = folder.file("last.json"), rest = folder.file("rest.json");
  const std::string recording = folder.file("run.weft");
  const auto whole = report_of(folder, run + "88 --out " + last + " --record " + recording);
  CHECK(run_program(folder, "replay " + recording).exit_code == 0);
  const auto expected = read_scene_file(last).value().description.positions;
  CHECK(std::abs(expected[3].y) < 1e-4);  // sewn on again
  for (const int first : {16, 40, 48, 60}) {
    CAPTURE(first);
    const std::string begun = run + std::to_string(first);
    report_of(folder, begun + " --save " + state + " --out " + half);
    const auto resumed = report_of(folder, run + "88 --resume " + state);
    CHECK(resumed["state_hash"] == whole["state_hash"]);
    report_of(folder, half + " --solver small_steps --dt 1/64 --steps " +
                          std::to_string(88 - first) + " --out " + rest);
    const auto positions = read_scene_file(rest).value().description.positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      CAPTURE(i);
      CHECK(positions[i].x == doctest::Approx(expected[i].x).epsilon(0.01));
      if (i != 3) CHECK(positions[i].y == doctest::Approx(expected[i].y).epsilon(0.02));
    }
  }
}

/// A chain of 1 m that hangs, and grows to 1.5 m from 0.25 s to 1 s.
std::string growing_scene(const TemporaryFolder& folder) {
  SceneDescription scene;
  for (std::uint32_t i = 0; i <= 10; ++i) {
    scene.positions.push_back({0, -0.1 * i, 0});
    scene.masses.push_back(0.01);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.1});
  }
  scene.fixed = {0};
  return folder.write("growing.json", scene_text(scene, {}, {}, {}, {}, {{0.25, 1}, {1, 1.5}}));
}

TEST_CASE("cloth of a file grows by its times, at any frame rate, resumed or gone on with, too") {
  for (const int rate : {32, 64, 256}) {
    CAPTURE(rate);
    const TemporaryFolder folder;
    const std::string last = folder.file("last.json"), state = folder.file("state.weft");
    const std::string rest = folder.file("rest.json");
    const auto lowest = [](const std::string& file) {
      return -read_scene_file(file).value().description.positions.back().y;
    };
    const std::string dt = " --dt 1/" + std::to_string(rate) + " --steps ";
    const std::string run = growing_scene(folder) + dt, half = std::to_string(rate / 2);
    const auto whole = report_of(folder, run + std::to_string(rate));
    report_of(folder, run + half + " --save " + state + " --out " + last);
    CHECK(lowest(last) == doctest::Approx(1 + 0.5 / 3).epsilon(0.012));
    const auto resumed = report_of(folder, run + std::to_string(rate) + " --resume " + state);
    CHECK(resumed["state_hash"] == whole["state_hash"]);
    report_of(folder, last + dt + half + " --out " + rest);
    CHECK(lowest(rest) == doctest::Approx(1.5).epsilon(0.012));
  }
}

TEST_CASE("rails and sliders survive writing and reading") {
  SceneDescription scene = hanging_scene();
  scene.rail_particles = {0, 1, 2, 0};
  scene.sliders = {{3, 0, 3, 1.0 / 3}, {4, 1, 2, 0}};
  const std::string text = scene_text(scene);
  const auto again = parse_scene(text);
  REQUIRE(again);
  CHECK(scene_text(again.value().description) == text);
  CHECK(again.value().description.rail_particles == scene.rail_particles);
  REQUIRE(again.value().description.sliders.size() == 2);
  CHECK(again.value().description.sliders[0].friction == 1.0 / 3);
  CHECK(again.value().description.sliders[1].last == 2);
}

}  // namespace
}  // namespace weft::tools
