/// When a loop that does not end is taken for one that gets nowhere.
#include "engine/step/standstill.h"

#include <doctest/doctest.h>

#include <cmath>

namespace weft::test {
namespace {

constexpr double kTolerance = 0.01, kContactTolerance = 1e-4;

Standstill watched(double stood_at = 0) {
  Settings settings;
  settings.tolerance = kTolerance;
  settings.contact_tolerance = kContactTolerance;
  return {settings, stood_at};
}

/// A look at constraints that are out by `error` tolerances beyond the first.
void look(Standstill& standstill, double error) {
  standstill.look({.max = (1 + error) * kTolerance, .rms = kTolerance}, 0);
}

TEST_CASE("errors that do not fall raise doubt, and once in doubt the same errors are the end") {
  Standstill standstill = watched();
  for (int looks = 1; looks <= 4; ++looks) look(standstill, 9);
  CHECK_FALSE(standstill.in_doubt());
  look(standstill, 9);
  CHECK(standstill.in_doubt());
  CHECK_FALSE(standstill.reached());
  look(standstill, 9);
  CHECK(standstill.reached());
  CHECK(standstill.error() == doctest::Approx(9));
}

TEST_CASE("as long as the rms or a penetration changes, nothing stands still") {
  Standstill by_rms = watched(), by_penetration = watched();
  for (int looks = 0; looks < 30; ++looks) {
    const double part = std::pow(0.99, looks);
    by_rms.look({.max = 10 * kTolerance, .rms = part * kTolerance}, 0);
    by_penetration.look({.max = 10 * kTolerance, .rms = kTolerance}, part * kContactTolerance);
    CHECK_FALSE(by_rms.reached());
    CHECK_FALSE(by_penetration.reached());
  }
}

TEST_CASE("contacts count like constraints") {
  Standstill standstill = watched();
  standstill.look({.max = kTolerance, .rms = 0}, 10 * kContactTolerance);
  CHECK(standstill.error() == doctest::Approx(9));
}

TEST_CASE("what stood still before does after two looks, unless it falls") {
  Standstill stands = watched(9), falls = watched(9);
  CHECK(stands.in_doubt());
  look(stands, 10);
  CHECK_FALSE(stands.reached());
  look(stands, 9.9);
  CHECK(stands.reached());
  for (double error = 20; error > 9; error *= 0.97) {
    look(falls, error);
    CHECK_FALSE(falls.reached());
  }
}

constexpr int kWindow = 32;

TEST_CASE("errors that rise and fall for ever stand still, those that only fall slowly do not") {
  Standstill wanders = watched(), falls = watched();
  for (int looks = 0; looks < 4 * kWindow; ++looks) {
    look(wanders, looks % 2 == 0 ? 9 : 9.05);
    look(falls, 9 * std::pow(1 - 1e-4, looks));
    CHECK_FALSE(falls.reached());
    if (wanders.reached()) break;
  }
  CHECK(wanders.reached());
}

TEST_CASE("the least error of a window is held against that of the one before, not of all") {
  Standstill standstill = watched();
  for (int looks = 0; looks < 5; ++looks) look(standstill, 20);
  REQUIRE(standstill.in_doubt());
  const auto window = [&](auto&& error) {
    for (int looks = 0; looks < kWindow; ++looks) {
      look(standstill, error(looks));
      CHECK_FALSE(standstill.reached());
    }
  };
  window([](int looks) { return looks == 0 ? 5 : 19 - 0.1 * looks; });  // a good one by chance
  window([](int looks) { return 12 - 0.05 * looks; });
  window([](int looks) { return looks % 2 == 0 ? 9 : 8 + 0.001 * looks; });
}

}  // namespace
}  // namespace weft::test
