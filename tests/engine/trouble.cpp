/// What steps in which a solver gave up, or that were expensive, mean for the next ones.
#include "engine/trouble.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "engine/step.h"
#include "tests/support/clothes.h"

namespace weft::test {
namespace {

constexpr StepRecord kExpensive{.may_be_swept = true, .passes = 1e6};
constexpr StepRecord kSwept{.made_do = true, .only_sweeps = true, .may_be_swept = true};

/// Sweeps alone come next.
Trouble after_expensive_steps() {
  Trouble trouble;
  for (int k = 0; k < 2; ++k) trouble.remember(kExpensive);
  REQUIRE(trouble.only_sweeps());
  return trouble;
}

int steps_of_sweeps(Trouble& trouble) {
  int steps = 0;
  for (; trouble.only_sweeps() && steps < 100; ++steps) trouble.remember(kSwept);
  return steps;
}

TEST_CASE("after halves that helped the allowance is less, down to a quarter, for a while") {
  Trouble trouble;
  const StepRecord halved{.halved = true};
  for (const double allowance : {0.5, 0.25, 0.25}) {
    trouble.remember(halved);
    CHECK(trouble.allowance() == allowance);
    CHECK(trouble.may_halve());
  }
  trouble.remember({});
  CHECK(trouble.allowance() == doctest::Approx(0.25 * 1.01));
  for (int k = 0; k < 140; ++k) trouble.remember({});
  CHECK(trouble.allowance() == 1);
}

TEST_CASE("where halves are no answer they are not tried for 1, 2, 4, ... 64 steps") {
  Trouble trouble;
  trouble.remember({.halved = true});
  for (const int pause : {1, 2, 4, 8, 16, 32, 64, 64}) {
    trouble.remember({.halved = true, .helped = false});
    CHECK(trouble.allowance() == 1);
    int steps = 0;
    for (; !trouble.may_halve() && steps < 100; ++steps) trouble.remember({});
    CHECK(steps == pause);
  }
  trouble.remember({});  // a step that needed none
  trouble.remember({.helped = false});
  trouble.remember({});
  CHECK(trouble.may_halve());
}

TEST_CASE("one step alone is not expensive enough for sweeps, whatever it took") {
  Trouble trouble;
  trouble.remember({.may_be_swept = true, .passes = 1e9});
  for (int k = 0; k < 10; ++k) {
    CHECK_FALSE(trouble.only_sweeps());
    trouble.remember({.may_be_swept = true, .passes = 10});
  }
}

TEST_CASE(
    "expensive steps are followed by 8, 16, ... of sweeps, the last of which tries yarns again") {
  Trouble trouble = after_expensive_steps();
  for (const int pause : {8, 16, 32, 64, 64}) {
    CHECK(steps_of_sweeps(trouble) == pause - 1);
    CHECK_FALSE(trouble.may_halve());
    trouble.remember({.made_do = true, .may_be_swept = true});
  }
  steps_of_sweeps(trouble);
  trouble.remember({.may_be_swept = true});  // this time yarns have a solution
  CHECK_FALSE(trouble.only_sweeps());
}

TEST_CASE("sweeps in vain, or more of them than yarns take, are not tried again for 64 steps") {
  for (const bool in_vain : {false, true}) {
    CAPTURE(in_vain);
    Trouble trouble = after_expensive_steps();
    const double passes = in_vain ? 0 : 2e6;
    trouble.remember({.only_sweeps = true, .swept_in_vain = in_vain, .passes = passes});
    CHECK(trouble.may_halve());
    for (int k = 0; k < 63; ++k) {
      CHECK_FALSE(trouble.only_sweeps());
      trouble.remember(kExpensive);
    }
    CHECK_FALSE(trouble.only_sweeps());
    trouble.remember(kExpensive);
    CHECK(trouble.only_sweeps());
  }
}

TEST_CASE("what sweeps take says nothing about yarns") {
  Trouble trouble = after_expensive_steps();
  const int before = trouble.most_sweeps();
  StepRecord swept = kSwept;
  swept.passes = 100;
  trouble.remember(swept);
  CHECK(trouble.most_sweeps() == before);
}

TEST_CASE("a state that is copied brings its trouble along, but not to other settings") {
  const auto model = model_of(scene_of("hang", 5));
  const Settings usual{.solver = Solver::gauss_seidel};
  State troubled(model, usual), alike(model, usual);
  troubled.trouble.remember({.halved = true});
  troubled.placed = false;
  alike.copy(troubled);
  CHECK(alike.trouble.allowance() == 0.5);
  CHECK_FALSE(alike.placed);
  State placed(model, usual);
  alike.copy(placed);
  CHECK(alike.placed);
  Settings others[6];
  std::ranges::fill(others, usual);
  others[0].solver = Solver::direct;
  others[1].scheme = Scheme::rattle;
  others[2].iterations = 3;
  others[3].tolerance /= 2;
  others[4].contact_tolerance /= 2;
  others[5].backend = Backend::reference;
  for (const Settings& settings : others) {
    State other(model, settings);
    other.placed = false;
    other.copy(troubled);
    CHECK(other.trouble.allowance() == 1);
    CHECK(other.placed);
  }
}

TEST_CASE("a step that did not converge is none that a shorter one is compared with") {
  const auto model = model_of(scene_of("corners", 9));
  for (const int most : {1, 10'000}) {
    CAPTURE(most);
    State state(model,
                {.substeps = 1, .max_iterations = most, .solver = Solver::yarn, .isa = Isa::sse2});
    state.last_dt = 0.2;
    const bool converged = step(state, 0.1).status == Status::converged;
    REQUIRE(converged == (most > 1));
    CHECK(state.last_dt == (converged ? 0.1 : 0));
  }
}

/// Whether a step that follows on expensive ones leaves the next to sweeps alone.
bool leaves_to_sweeps(const SceneDescription& scene, Settings settings) {
  settings.solver = Solver::yarn;
  settings.isa = Isa::sse2;
  settings.velocity_correction = settings.scheme == Scheme::rattle;
  State state(model_of(scene), settings);
  for (int k = 0; k < 3; ++k) state.trouble.remember({.passes = 1e6});
  step(state, 0.01);
  return state.trouble.only_sweeps();
}

TEST_CASE("with spheres, tight tolerances or scheme rattle nothing is left to sweeps alone") {
  SceneDescription scene = scene_of("hang", 8);
  CHECK(leaves_to_sweeps(scene, {}));
  CHECK_FALSE(leaves_to_sweeps(scene, {.tolerance = 0.003}));
  CHECK_FALSE(leaves_to_sweeps(scene, {.scheme = Scheme::rattle}));
  scene.spheres = {static_cast<std::uint32_t>(scene.positions.size())};
  scene.fixed.push_back(scene.spheres[0]);
  scene.positions.push_back({0, 100, 0});  // far from everything
  scene.masses.push_back(1);
  scene.radii.assign(scene.positions.size(), 1);
  CHECK_FALSE(leaves_to_sweeps(scene, {}));
}

struct AfterTrouble {
  StepReport usual, careful;
};

AfterTrouble after_trouble(int size, int substeps) {
  Settings settings;
  settings.substeps = substeps;
  settings.solver = Solver::yarn;
  settings.isa = Isa::sse2;
  const auto model = model_of(scene_of("hang", size));
  State usual(model, settings), careful(model, settings);
  for (int k = 0; k < 6; ++k) step(usual, 0.02);
  careful.copy(usual);
  for (int k = 0; k < 2; ++k) careful.trouble.remember({.halved = true});
  return {step(usual, 0.02), step(careful, 0.02)};
}

TEST_CASE("less allowance: more substeps, and yarns solved more closely") {
  const AfterTrouble automatic = after_trouble(8, kAutomaticSubsteps);
  CHECK(automatic.usual.substeps == 1);
  CHECK(automatic.careful.substeps == 2);
  const AfterTrouble one = after_trouble(31, 1);
  CHECK(one.careful.max_strain < one.usual.max_strain / 2);
}

}  // namespace
}  // namespace weft::test
