/// Measures a motion that was computed elsewhere with weft's own measures.
#pragma once

#include <weft/weft.h>

#include <span>

#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

class Meter {
 public:
  explicit Meter(const Task& task);
  /// One more frame. False: its state is not finite, and nothing was measured.
  bool add_frame(std::span<const Vec3> positions, std::span<const Vec3> velocities, double seconds);
  /// The status is left to the caller.
  Outcome outcome() const;
  double seconds() const { return seconds_; }
  double max_strain() const { return sums_.max_strain; }

 private:
  const Task* task_;
  Cloth cloth_;
  double energy_start_;
  double seconds_ = 0;
  double strain_sum_ = 0;
  Outcome sums_;
};

}  // namespace weft::tools::precision
