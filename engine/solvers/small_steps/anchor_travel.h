/// How anchors move in a step, and where they are in each of its substeps.
#pragma once

#include <cstdint>
#include <span>

#include "engine/model/model.h"
#include "kernels/reference/anchors.h"

namespace weft {

/// In the order of the model's anchors.
struct AnchorTravel {
  std::span<const reference::AnchorPose> from, to;
  std::span<const double> most_from, most_to;  // m, largest distances
  std::span<const std::uint8_t> has_backstop;
  bool moving = false;   // points or normals, in this step or in the last
  bool limited = false;  // limits are not those of the model

  /// m, in a share of the step.
  double most(std::uint32_t anchor, double share) const {
    const double from = most_from[anchor], to = most_to[anchor];
    return from == to ? to : from + share * (to - from);
  }
};

class AnchorClock {
 public:
  explicit AnchorClock(const AnchorStore& store) : store_(store) {}

  void begin(const AnchorTravel& travel, double h, int substeps) {
    travel_ = travel;
    per_second_ = 1 / (h * substeps);
    substeps_ = substeps;
    done_ = 0;
  }
  /// Advances by a substep, in its end.
  void advance() { ++done_; }

  const AnchorTravel& travel() const { return travel_; }
  double share() const { return static_cast<double>(done_) / substeps_; }
  double per_second() const { return per_second_; }
  reference::AnchorMotion motion(std::uint32_t anchor) const {
    return reference::AnchorMotion::between(travel_.from[anchor], travel_.to[anchor], share(),
                                            per_second_);
  }
  reference::AnchorLimits limits(std::uint32_t anchor) const {
    reference::AnchorLimits limits = store_.limits[anchor];
    limits.most = travel_.most(anchor, share());
    limits.has_backstop = limits.has_backstop && travel_.has_backstop[anchor] != 0;
    return limits;
  }
  reference::Held hold(std::uint32_t anchor, kernels::Vector x, kernels::Vector v) const {
    return reference::hold(limits(anchor), motion(anchor), x, v);
  }

 private:
  const AnchorStore& store_;
  AnchorTravel travel_;
  double per_second_ = 0;
  int substeps_ = 1, done_ = 0;
};

}  // namespace weft
