/// What steps in which a solver gave up mean for the next ones.
#include "engine/step/trouble.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "engine/step/step.h"
#include "tests/support/clothes.h"

namespace weft::test {
namespace {

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
