/// The places of bodies in each substep of a step.
#pragma once

#include <span>
#include <vector>

#include "engine/bodies/bodies.h"
#include "kernels/reference/bodies.h"

namespace weft {

class BodyClock {
 public:
  /// stands: bodies stay where they begin, have no friction, and particles under their surface come
  /// out at once. Written positions are projected in this way.
  void begin(std::span<const TravellingBody> bodies, double dt_substep, int substeps, bool stands);
  /// To the next substep.
  void advance();

  std::span<const TravellingBody> bodies() const { return bodies_; }
  /// In the present substep, in the order of the bodies; before the first one where they begin.
  std::span<const reference::BodyMotion> motions() const { return motions_; }
  /// A box around a body from now to the end of some substeps.
  struct Box {
    kernels::Vector low{}, high{};
  };
  Box box(std::size_t body, int substeps) const;
  /// m/s: no point of the body is faster in this step; of a plane, its centre.
  double fastest(std::size_t body) const;
  /// Intervals of some substeps: contacts of all kinds are looked for when one begins. It has as
  /// many of the substeps that are left as such a time has, one at least.
  void begin_interval(double time);
  int substeps_of_interval() const { return interval_; }
  /// Substeps of the step, the present one included; while bodies stand, one.
  int substeps_left() const { return stands_ ? 1 : substeps_ - done_; }
  bool begins_interval() const { return interval_ > 0 && interval_left_ == interval_; }
  bool is_interval_over() const { return interval_left_ == 0; }
  /// Where a vertex of a body that is a mesh is at a share of the step, when its pose is `at`.
  kernels::Vector vertex(std::size_t body, std::size_t vertex, const reference::Placement& at,
                         double share) const {
    const TravellingBody& b = bodies_[body];
    return at.placed(b.from[vertex] + share * (b.to[vertex] - b.from[vertex]));
  }
  /// The share of the step that is over some substeps from now.
  double share_after(int substeps) const { return share(done_ + substeps); }
  bool stands() const { return stands_; }
  double time() const { return dt_substep_ * substeps_; }  // s, of the step
  /// s, of a substep. It is infinite while bodies stand: a particle under a surface comes out at
  /// once, and no way is a velocity.
  double dt_substep() const;
  std::size_t bytes() const {
    return motions_.capacity() * sizeof(motions_[0]) + bodies_.capacity() * sizeof(bodies_[0]);
  }

 private:
  double share(int substeps) const {
    return stands_ ? 0 : static_cast<double>(substeps) / substeps_;
  }

  std::vector<TravellingBody> bodies_;  // their own: contacts are read when bodies may be gone
  std::vector<reference::BodyMotion> motions_;
  double dt_substep_ = 0;
  int substeps_ = 1, done_ = 0;
  int interval_ = 0, interval_left_ = 0;  // substeps
  bool stands_ = false;
};

}  // namespace weft
