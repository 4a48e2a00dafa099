/// Cloths of a host that are recorded: whatever it calls, a replay comes to the same bits.
#include <doctest/doctest.h>
#include <weft/mesh.h>
#include <weft/weft_c.h>

#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "engine/recording/patches.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/recording/replay.h"

namespace weft::tools {
namespace {

Cloth cloth_of(const SceneDescription& description, const Settings& settings = {}) {
  auto cloth = Cloth::create(build_model(description).value(), settings);
  REQUIRE(cloth);
  return std::move(cloth).value();
}

/// A square of cloth that hangs by its first particle.
SceneDescription square() {
  MeshDescription mesh;
  constexpr std::uint32_t kSide = 7;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column)
      mesh.positions.push_back({0.05 * column, 0, 0.05 * row});
  }
  for (std::uint32_t row = 0; row + 1 < kSide; ++row) {
    for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
      const std::uint32_t at = row * kSide + column;
      for (const std::uint32_t corner : {at, at + 1, at + kSide + 1, at + kSide})
        mesh.corners.push_back(corner);
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.material = find_material("cotton").value();
  mesh.pins = {0};
  const auto made = cloth_from_mesh(mesh);
  REQUIRE(made);
  return made.value().scene;
}

/// That it replays every step to the same bits.
Recording checked(const std::string& file) {
  const auto recording = read_recording(file);
  REQUIRE(recording);
  const auto summary = replay(recording.value(), {});
  if (!summary) FAIL(summary.error());
  CHECK(!summary.value().difference);
  CHECK(summary.value().last_step == static_cast<int>(recording.value().steps.size()));
  return recording.value();
}

TEST_CASE("every call between steps is replayed") {
  const TemporaryFolder folder;
  const std::string file = folder.file("cloth.weft");
  Cloth cloth = cloth_of(square());
  const std::size_t count = cloth.particle_count();
  const Cloth start = cloth.clone();
  std::vector<Vec3> values(count);
  std::uint32_t ball = 0;
  std::vector<std::byte> state;
  const std::vector<std::function<Result<void>()>> calls = {
      [&] { return Result<void>{}; },
      [&] {
        return cloth.set_gravity({0, -5, 1});
      },
      [&] {
        return cloth.set_wind({2, 0, 0});
      },
      [&] {
        return cloth.write_forces(std::vector<Vec3>(count, {0, 0, 1e-3}));
      },
      [&] {
        return cloth.move_fixed(0, {0, 0.01, 0});
      },
      [&] {
        return cloth.place_fixed(0, {0.02, 0.01, 0});
      },
      [&] {
        return cloth.carry({.translation = {0.01, 0, 0}}, 0.5);
      },
      [&] {
        return cloth.teleport({.rotation = {0, 1, 0}});
      },
      [&] {
        const auto added = cloth.add_body({.shape = build_shape(Ball{{0, -0.3, 0}, 0.1}).value()});
        REQUIRE(added);
        ball = added.value();
        return Result<void>{};
      },
      [&] {
        return cloth.move_body(ball, {.position = {0, 0.05, 0}});
      },
      [&] {
        return cloth.place_body(ball, {.position = {0, 0.06, 0}});
      },
      [&] {
        state = cloth.save_state();
        return cloth.switch_body(ball, false);
      },
      [&] { return cloth.remove_body(ball); },
      [&] { return cloth.read_positions(values); },
      [&] { return cloth.write_positions(values); },
      [&] {
        return cloth.write_velocities(std::vector<Vec3>(count, {0, 1, 0}));
      },
      [&] { return cloth.set_pressure(5); },
      [&] { return cloth.load_state(state); },
      [&] { return cloth.change({.release = {0}}); },
      [&] { return cloth.change({.damping = Damping{.motion = 0.5}}); },
      [&] { return cloth.copy_state(start); },
  };
  REQUIRE(cloth.begin_recording(file, "all calls"));
  for (std::size_t i = 0; i < calls.size(); ++i) {
    CAPTURE(i);
    REQUIRE(calls[i]());
    REQUIRE(cloth.step(i % 2 == 0 ? 1.0 / 60 : 0.01));
  }
  REQUIRE(cloth.end_recording());
  const Recording recording = checked(file);
  CHECK(recording.is_finished);
  CHECK(recording.start.note == "all calls");
  CHECK(recording.steps.size() == calls.size());
  CHECK(recording.steps[0].calls.state.empty());
  CHECK(recording.steps[3].calls.dt == 0.01);
  CHECK(!recording.steps[18].calls.model.empty());
  CHECK(recording.steps.back().result->hash == cloth.state_hash());
}

TEST_CASE("a recording is that of its cloth: moved, in a batch, but not of a clone") {
  const TemporaryFolder folder;
  const std::string file = folder.file("cloth.weft"), other = folder.file("other.weft");
  Cloth first = cloth_of(square()),
        second = cloth_of(square(), {.substeps = 6, .solver = Solver::small_steps});
  REQUIRE(first.begin_recording(file));
  REQUIRE(second.begin_recording(other));
  Cloth moved = std::move(first);
  Cloth clone = moved.clone();
  REQUIRE(clone.step(0.01));
  CHECK_FALSE(clone.end_recording());
  std::vector<ClothStep> steps = {{.cloth = &moved, .dt = 0.01}, {.cloth = &second, .dt = 0.02}};
  for (int i = 0; i < 3; ++i) step_all(steps);
  REQUIRE(moved.end_recording());
  REQUIRE(second.end_recording());
  for (const std::string& each : {file, other}) {
    const Recording recording = checked(each);
    CHECK(recording.steps.size() == 3);
    CHECK(recording.start.note.empty());
  }
  CHECK(checked(other).start.settings.substeps == 6);
}

TEST_CASE("a step is in the file before it begins, and one that is refused leaves nothing") {
  const TemporaryFolder folder;
  const std::string file = folder.file("cloth.weft");
  auto cloth = std::make_unique<Cloth>(cloth_of(square()));
  const std::size_t bytes = cloth->bytes();
  REQUIRE(cloth->begin_recording(file));
  CHECK(cloth->bytes() >= bytes + cloth->save_state().size());
  REQUIRE(cloth->step(0.01));
  CHECK_FALSE(cloth->step(-1));
  REQUIRE(cloth->step(0.01));
  CHECK(read_recording(file).value().steps.size() == 2);
  cloth.reset();
  CHECK_FALSE(checked(file).is_finished);
}

TEST_CASE("a recording that cannot be is refused in one line") {
  const TemporaryFolder folder;
  Cloth cloth = cloth_of(square());
  CHECK(cloth.end_recording().error() == "recording: nothing is being recorded (none)");
  const auto nowhere = cloth.begin_recording(folder.file("no/such"));
  REQUIRE(!nowhere);
  CHECK(nowhere.error().starts_with("path: cannot be written ("));
  CHECK(nowhere.error().ends_with("/no/such: No such file or directory)"));
  REQUIRE(cloth.begin_recording(folder.file("a")));
  const auto twice = cloth.begin_recording(folder.file("b"));
  REQUIRE(!twice);
  CHECK(twice.error().starts_with("path: the cloth is being recorded already ("));
  REQUIRE(cloth.end_recording());
}

TEST_CASE("a disk that is full is told when the recording ends, and steps go on") {
  Cloth cloth = cloth_of(square());
  const auto begun = cloth.begin_recording("/dev/full");
  REQUIRE(!begun);
  CHECK(begun.error() == "path: cannot be written (/dev/full: No space left on device)");
  CHECK(cloth.step(0.01));
}

TEST_CASE("the C interface records the same file") {
  const TemporaryFolder folder;
  const std::string from_cpp = folder.file("cpp.weft"), from_c = folder.file("c.weft");
  Cloth cloth = cloth_of(square());
  REQUIRE(cloth.begin_recording(from_cpp, "a note"));
  REQUIRE(cloth.step(0.01));
  REQUIRE(cloth.end_recording());

  const std::vector<std::byte> model = save_model(*cloth.model());
  weft_model* c_model = nullptr;
  weft_cloth* c = nullptr;
  REQUIRE(weft_load_model(model.data(), model.size(), &c_model) == WEFT_OK);
  REQUIRE(weft_create_cloth(c_model, nullptr, &c) == WEFT_OK);
  CHECK(weft_begin_recording(c, nullptr, nullptr) == WEFT_REFUSED);
  REQUIRE(weft_begin_recording(c, from_c.c_str(), "a note") == WEFT_OK);
  REQUIRE(weft_step(c, 0.01, nullptr, nullptr) == WEFT_OK);
  REQUIRE(weft_end_recording(c) == WEFT_OK);
  CHECK(weft_end_recording(c) == WEFT_REFUSED);
  weft_free_cloth(c);
  weft_free_model(c_model);
  CHECK(folder.read("c.weft") == folder.read("cpp.weft"));
  checked(from_c);
}

TEST_CASE("patches make of bytes what they are to be, and little more than what differs") {
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::byte> before(below(200));
    for (std::byte& each : before) each = std::byte(below(3));
    std::vector<std::byte> after = before;
    if (below(2) == 0) after.resize(below(200));
    for (std::size_t change = below(6); change > 0 && !after.empty(); --change)
      after[below(after.size())] = std::byte(below(256));
    const std::vector<Patch> made = patches(before, after);
    const auto whole = patched(before, made);
    REQUIRE(whole);
    CHECK(whole.value() == after);
  }
  std::vector<std::byte> before(10'000), after(10'000);
  after[77] = after[9'000] = std::byte{1};
  const std::vector<Patch> two = patches(before, after);
  REQUIRE(two.size() == 2);
  CHECK(two[0].put.size() == 1);
  CHECK_FALSE(patched(std::span(before).first(9'000), two));
  CHECK(patches(before, before).empty());
}

}  // namespace
}  // namespace weft::tools
