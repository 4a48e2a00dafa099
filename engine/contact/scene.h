/// The data that the stages of an interval share in a substep.
#pragma once

#include "engine/contact/impulses.h"
#include "engine/contact/particles.h"
#include "engine/contact/points.h"
#include "engine/contact/present_points.h"
#include "engine/contact/tangles.h"
#include "engine/contact/thickness_shares.h"

namespace weft {

struct ContactScene {
  const Model& model;
  const BodyClock& clock;
  ContactPoints& points;
  PresentPoints& present;
  ContactParticles& particles;
  ContactImpulses& impulses;
  const Tangles& tangles;
  ThicknessShares& shares;

  /// A point in the present substep; a vertex of a body is one that was asked for.
  ContactParticle read(std::uint32_t point) const {
    if (points.is_of_cloth(point)) return particles.read(point);
    return present[point];
  }
  /// A particle that the caller moves is as fast as that.
  ContactParticle read_moving(std::uint32_t slot) const {
    ContactParticle particle = particles.read(slot);
    if (points.inverse_mass(slot) == 0)
      particle.v = (1 / clock.dt_substep()) * (particle.x - particle.start);
    return particle;
  }
  /// Where that is.
  kernels::Vector place(std::uint32_t point) const {
    return points.is_of_cloth(point) ? particles.position(point) : present[point].x;
  }
  /// And where it was when the substep began.
  kernels::Vector start(std::uint32_t point) const {
    return points.is_of_cloth(point) ? particles.start(point) : present[point].start;
  }
  /// The thinning of a body at a feature of the cloth, whose points count by their weights.
  reference::Thinning thinning(const std::array<std::uint32_t, 4>& four,
                               const std::array<double, 4>& weights, std::uint32_t body) const {
    reference::Thinning sum;
    if (!shares.any()) return sum;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!points.is_of_cloth(four[k])) continue;
      const reference::Thinning of = shares.of(four[k], body);
      const double w = std::abs(weights[k]);
      sum = {sum.by + w * of.by, sum.retreat + w * of.retreat};
    }
    return sum;
  }
  /// Where any point is when the present substep ends.
  kernels::Vector now(std::uint32_t point) const {
    return points.is_of_cloth(point) ? particles.position(point) : points.vertex_now(clock, point);
  }
};

}  // namespace weft
