/// Scenes and settings drawn by chance: all of a case follows from its seed, on every machine.
///
///   WEFT_SEED=s    cases s, s + 1, ... instead of 1, 2, ...: WEFT_SEED=s WEFT_CASES=1 is case s
///   WEFT_CASES=n   so many of them in every test, instead of what the test says
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace weft::test {

struct RandomCase {
  std::uint32_t seed = 0;
  std::string shape;
  SceneDescription scene;
  std::vector<Vec3> forces;  // or none
  Settings settings;
  double dt = 0.01;
  int steps = 1;
  bool moves_pins = false;

  /// s, of step k: dt at first. Where frames vary the others are 4/33 of dt to all of it.
  double frame(int k) const;
  bool frames_vary() const { return seed % 3 == 0; }
};

/// Anything that build_model and Cloth::create take, except what they say they cannot do.
RandomCase random_case(std::uint32_t seed);
/// The same with springs of any stiffness among its constraints, some of them damped, by what takes
/// springs.
RandomCase softened_case(std::uint32_t seed);
/// Triangles of fabric of any stiffness between particles that constraints join, with these and
/// without, some softened, by small steps.
RandomCase fabric_case(std::uint32_t seed);
/// Bars alone, about at their lengths, of masses within a decade, no edge bent by much in the step,
/// to a tight tolerance.
RandomCase gentle_case(std::uint32_t seed);

/// Ropes alone, none too long at the start, at most one particle fixed; gravity, no other forces.
RandomCase roped_case(std::uint32_t seed);

/// What a failed check prints: how to have the same case again, and what it is.
std::string text(const RandomCase& c);

/// The same in every run unless the environment says otherwise.
struct Seeds {
  std::uint32_t first, count;
};
Seeds seeds(std::uint32_t count);

template <class Draw, class Check>
void for_each_case(std::uint32_t count, Draw&& draw, Check&& check) {
  const Seeds s = seeds(count);
  for (std::uint32_t i = 0; i < s.count; ++i) check(draw(s.first + i));
}

}  // namespace weft::test
