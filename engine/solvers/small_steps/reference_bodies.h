/// Particles beside bodies, one by one: each is held against all bodies in every substep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/body_report.h"

namespace weft {

class ReferenceBodies {
 public:
  explicit ReferenceBodies(const Model& model) : model_(model) {}

  using Touching = std::vector<bool>;  // per slot

  bool empty() const { return clock_.bodies().empty(); }
  /// before: who touched a body when the frame before ended; empty: nothing is known of it.
  void begin(std::span<const TravellingBody> bodies, double h, int substeps, bool stands,
             const Touching& before);
  /// part: of h, by the scheme.
  void advance(double part);
  /// Moves a particle that went from start to x, with the velocity v there. Returns whether it
  /// touches a body.
  bool hold(std::uint32_t slot, kernels::Vector& start, kernels::Vector& x, kernels::Vector& v);
  /// After that: whether it did not in this substep before, and not when the last one ended.
  bool begins_to_touch(std::uint32_t slot);
  const Touching& touching() const { return on_; }
  double deepest(const kernels::Vectors& start, const kernels::Vectors& x) const;
  void sum(BodyReport& report) const;
  void read_contacts(std::vector<BodyTouch>& contacts) const;

 private:
  double radius(std::uint32_t slot) const {
    return model_.has_contacts() ? model_.radius[slot] : 0;
  }

  const Model& model_;
  BodyClock clock_;
  double stays_ = 1;                    // of a change of velocity in contact, as momentum
  std::vector<reference::Grip> grips_;  // per slot and body
  Touching on_, before_;
  std::vector<BodyImpulse> impulses_;
  double friction_ = 0;
};

}  // namespace weft
