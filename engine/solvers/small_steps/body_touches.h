/// What both solvers of small steps tell of contacts.
#pragma once

#include <vector>

#include "engine/contact/mesh_contacts.h"
#include "engine/solvers/small_steps/body_report.h"

namespace weft {

/// x: where the particle is that touches a body of a closed form.
inline BodyTouch touch_of(const BodyClock& clock, std::size_t body, std::uint32_t slot,
                          kernels::Vector x, double push) {
  const reference::BodyMotion& motion = clock.motions()[body];
  const reference::Gap gap = gap_of(motion.solid, 0, motion.to.from_place(x));
  const kernels::Vector normal = motion.to.turned(gap.normal);
  return {slot, clock.bodies()[body].id, push, x - gap.gap * normal, normal};
}

/// Adds what meshes have done.
inline void add_report(const MeshContacts& meshes, BodyReport& report) {
  if (meshes.empty()) return;
  const MeshImpulses& its = meshes.impulses();
  for (std::size_t body = 0; body < report.impulses.size(); ++body) {
    BodyImpulse& sum = report.impulses[body];
    sum.linear = sum.linear + its.of_body[body].linear;
    sum.angular = sum.angular + its.of_body[body].angular;
  }
  report.work += its.work;
  report.friction += its.friction;
  report.contacts += meshes.count_touching();
  report.failures = meshes.failures();
}
inline void add_touches(const MeshContacts& meshes, const ContactParticles& particles,
                        const BodyClock& clock, std::vector<BodyTouch>& contacts) {
  if (meshes.empty()) return;
  std::vector<MeshTouch> touches;
  meshes.read_touching(particles, touches);
  for (const MeshTouch& touch : touches) {
    contacts.push_back(
        {touch.slot, clock.bodies()[touch.body].id, touch.push, touch.point, touch.normal});
  }
}

}  // namespace weft
