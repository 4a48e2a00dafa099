/// The hull of a point's motion in some time: a box at its start, a box at its end, and the space
/// between them on straight lines. Tubes of points that move side by side stay apart, where boxes
/// around their whole paths would overlap.
#pragma once

#include <cmath>

#include "engine/triangles/box_tree.h"

namespace weft {

struct Tube {
  Box begins, ends;

  Box all() const {
    Box box = begins;
    box.add(ends);
    return box;
  }
  bool hold(const Box& box) const { return begins.holds(box) && ends.holds(box); }
  simd::PointTube in_lanes() const {
    simd::PointTube tube{};
    for (std::size_t end = 0; end < 2; ++end) {
      const Box& box = end == 0 ? begins : ends;
      for (std::size_t k = 0; k < 3; ++k) {
        const float middle = 0.5f * (box.low[k] + box.high[k]), half = box.high[k] - middle;
        tube.low[end][k] = box.low[k];
        tube.high[end][k] = box.high[k];
        tube.middle[end][k] = middle;
        tube.half[end][k] = half;
        tube.middle[end][3] += std::abs(middle) + half;
      }
    }
    return tube;
  }

  /// A part of the time of a tube, in shares of it.
  class Part {
   public:
    Part(double from, double to) : from_(static_cast<float>(from)), to_(static_cast<float>(to)) {}
    Tube of(const Tube& tube) const { return {at(tube, from_), at(tube, to_)}; }

   private:
    static Box at(const Tube& tube, float share) {
      Box box;
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = tube.begins.low[k] + share * (tube.ends.low[k] - tube.begins.low[k]);
        box.high[k] = tube.begins.high[k] + share * (tube.ends.high[k] - tube.begins.high[k]);
      }
      return box;
    }
    float from_, to_;
  };
};

}  // namespace weft
