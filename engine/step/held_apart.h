/// Seams and lengths that two held particles exclude. Held particles are fixed ones, and those of
/// anchors with a largest distance of 0: no solver moves them.
#pragma once

#include <weft/scene.h>

#include <cstdint>

namespace weft {

struct State;

struct HeldApart {
  int count = 0;                        // constraints and open seams
  std::uint32_t constraint = kNoIndex;  // the one with the largest strain, in the description
  std::uint32_t seam = kNoIndex;        // the one with the widest gap
  /// A constraint is one of them, or a seam whose time is over: no pin can be on its way yet.
  bool is_infeasible = false;
};
HeldApart find_held_apart(const State& s);

}  // namespace weft
