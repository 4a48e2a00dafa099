/// Boxes of the world in the coordinates of a body that moves: there the tree of a rigid body
/// stands still, and a search needs no vertices in coordinates of the world.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/contact/tube.h"
#include "kernels/reference/bodies.h"

namespace weft {

struct SeenFromBody {
  reference::Placement begins, ends;  // from the origin of boxes
  double turn = 0, way = 0;           // rad, and m of its centre, between them
  double beyond = 0;                  // m: the distance it keeps

  /// Holds all places of the body, at any time on its way, that may be within `beyond` of the box.
  /// A place that turns by an angle stays within a part of its way of the line between its ends.
  Box operator()(const Box& box) const { return (*this)({box, box}); }
  /// The same of what moves in a straight line meanwhile.
  Box operator()(const Tube& tube) const {
    const Middle first(tube.begins), last(tube.ends);
    const kernels::Vector from = first.place - begins.centre, to = last.place - ends.centre;
    const double wide = length(first.half) + length(last.half);
    const double far = std::max(length(from), length(to)) + wide;
    const double moves = std::min(length(to - from), length(last.place - first.place) + way) + wide;
    const double spare = beyond + (turn * far + 2 * moves) * turn / 8;
    Box seen = at(begins, first, spare);
    if (turn > 0 || moves > 0) seen.add(at(ends, last, spare));
    return seen;
  }

 private:
  struct Middle {
    kernels::Vector place, half;
    explicit Middle(const Box& box) {
      double* const m[] = {&place.x, &place.y, &place.z};
      double* const h[] = {&half.x, &half.y, &half.z};
      for (std::size_t k = 0; k < 3; ++k) {
        const double low = static_cast<double>(box.low[k]), high = static_cast<double>(box.high[k]);
        *m[k] = 0.5 * (low + high);
        *h[k] = 0.5 * (high - low);
      }
    }
  };
  static Box at(const reference::Placement& place, const Middle& middle, double spare) {
    const kernels::Vector c = place.from_place(middle.place), half = middle.half;
    Box box;
    const kernels::Vector axes[] = {place.x, place.y, place.z};
    const double centre[] = {c.x, c.y, c.z};
    for (std::size_t k = 0; k < 3; ++k) {
      const double wide = std::abs(axes[k].x) * half.x + std::abs(axes[k].y) * half.y +
                          std::abs(axes[k].z) * half.z + spare;
      const double with_rounding = wide + kRounding * (std::abs(centre[k]) + wide);
      box.low[k] = static_cast<float>(centre[k] - with_rounding);
      box.high[k] = static_cast<float>(centre[k] + with_rounding);
    }
    return box;
  }
  static constexpr double kRounding = 0x1p-21;  // of floats, here and in the tree
};

}  // namespace weft
