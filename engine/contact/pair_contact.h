/// The contact of a near pair in the present substep.
#pragma once

#include <array>
#include <cstdint>

#include "engine/contact/look.h"
#include "engine/contact/scene.h"

namespace weft {

/// Its points where the substep began and where they are, and how it stands to its thickness.
struct PairContact {
  std::array<std::uint32_t, 4> points;
  FourPoints start, x;  // start: once it is read
  reference::Nearest nearest;
  kernels::Vector normal;  // from the second feature to the first, where both were on their sides
  double gap = 0;          // m
  reference::Thinning thinning{};  // of the body
  kernels::Vector arm{};           // m, from the body's feature to its surface
  bool is_under = false;           // one is on the wrong side of the other
  bool pushes = false;

  void read_start(const ContactScene& scene) {
    for (std::size_t k = 0; k < 4; ++k) start[k] = scene.start(points[k]);
  }
  FourPoints at_share(double share) const {
    FourPoints there;
    for (std::size_t k = 0; k < 4; ++k) there[k] = start[k] + share * (x[k] - start[k]);
    return there;
  }
};

}  // namespace weft
