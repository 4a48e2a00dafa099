/// Stall detection of loops that end at a tolerance: whether the error still falls.
#pragma once

#include <algorithm>
#include <limits>

#include "engine/tuning.h"

namespace weft {

class Stall {
 public:
  /// The error after another part of the work. Returns whether it has stalled: in more than
  /// kPatience parts it did not come below the share kFall of the least one before.
  bool has_stalled(double error) {
    parts_ = error < tuning::kFall * least_ ? 0 : parts_ + 1;
    least_ = std::min(least_, error);
    return parts_ > tuning::kPatience;
  }
  /// Whether a quarter of that has passed.
  bool is_near() const { return parts_ > tuning::kPatience / 4; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  int parts_ = 0;  // since it last fell
};

}  // namespace weft
