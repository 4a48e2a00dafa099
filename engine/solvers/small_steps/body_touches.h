/// The contacts that both stores of small steps report.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "engine/contact/interval.h"
#include "engine/solvers/small_steps/body_report.h"

namespace weft {

/// x: where the particle is that touches a body of a closed form.
inline BodyTouch touch_of(const BodyClock& clock, std::size_t body, std::uint32_t slot,
                          kernels::Vector x, double push) {
  const reference::BodyMotion& motion = clock.motions()[body];
  const reference::Gap gap = gap_of(*motion.form, 0, motion.to.from_place(x));
  const kernels::Vector normal = motion.to.turned(gap.normal);
  return {slot, clock.bodies()[body].id, push, x - gap.gap * normal, normal};
}

/// The one of several bodies of a closed form that is nearest to x.
class NearestForm {
 public:
  void consider(const BodyClock& clock, std::uint32_t body, kernels::Vector x) {
    const reference::BodyMotion& motion = clock.motions()[body];
    const reference::Gap gap = gap_of(*motion.form, motion.thickness, motion.to.from_place(x));
    if (gap.gap >= least_) return;
    least_ = gap.gap;
    body_ = body;
    normal_ = motion.to.turned(gap.normal);
  }
  /// Its surface, and its normal there; none where none was considered.
  std::pair<TouchedSurface, kernels::Vector> surface(const BodyClock& clock,
                                                     kernels::Vector x) const {
    if (body_ == kNoIndex) return {};
    return {{body_, clock.motions()[body_].velocity_at(x)}, normal_};
  }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  std::uint32_t body_ = kNoIndex;
  kernels::Vector normal_{};
};

/// A particle that arrives at a surface goes on as if it had been in flight: its velocity before,
/// on which BDF2 builds, is forgotten. `impulse` is the momentum that the particle gains by that,
/// and the body gives it. Friction takes the energy of its part along the surface, as far as
/// Coulomb's law allows.
inline void add_arrival(ContactImpulses& impulses, const BodyClock& clock,
                        const TouchedSurface& surface, kernels::Vector x, kernels::Vector v,
                        kernels::Vector impulse) {
  const reference::BodyMotion& body = clock.motions()[surface.body];
  impulses.add(surface.body, body.to.centre, x, impulse, surface.velocity);
  const kernels::Vector slides = v - surface.velocity;
  const double most = body.friction * length(impulse) * length(slides);
  impulses.friction -= std::clamp(dot(impulse, slides), -most, most);
}

inline void add(const ContactImpulses& impulses, const BodyClock& clock, BodyReport& report) {
  for (std::size_t body = 0; body < report.impulses.size(); ++body) {
    BodyImpulse& sum = report.impulses[body];
    sum.centre = clock.motions()[body].to.centre;
    sum.linear = sum.linear + impulses.of_body[body].linear;
    sum.angular = sum.angular + impulses.of_body[body].angular;
  }
  report.work += impulses.work;
  report.friction += impulses.friction;
}

/// Adds what meshes have done.
inline void add_report(const SurfaceContacts& meshes, const BodyClock& clock, BodyReport& report) {
  if (meshes.empty()) return;
  add(meshes.impulses(), clock, report);
  const SurfaceContacts::Touching touching = meshes.count_touching();
  report.contacts += touching.bodies;
  report.within_cloth = touching.within_cloth;
  report.failures = meshes.failures();
  report.untangling = meshes.untangling_work();
}

}  // namespace weft
