/// Stall detection of loops that end at a tolerance: whether the error still falls.
#pragma once

#include <algorithm>
#include <limits>

#include "engine/tuning.h"

namespace weft {

class Stall {
 public:
  explicit Stall(const tuning::Patience& patience) : patience_(patience) {}

  /// The error after another part of the work. Returns whether it has stalled.
  bool has_stalled(double error) {
    parts_ = error < patience_.fall * least_ ? 0 : parts_ + 1;
    least_ = std::min(least_, error);
    return parts_ > patience_.most;
  }
  /// Whether a quarter of the patience is spent.
  bool is_near() const { return parts_ > patience_.most / 4; }

 private:
  tuning::Patience patience_;
  double least_ = std::numeric_limits<double>::infinity();
  int parts_ = 0;  // since it last fell
};

}  // namespace weft
