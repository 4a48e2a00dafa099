#include "engine/step/carry.h"

#include <cmath>
#include <utility>

#include "engine/solvers/small_steps/small_steps.h"

namespace weft {

using kernels::Vector;

namespace {

/// A column of the rotation by |r| about r (Rodrigues).
Vector rotated(Vector axis, Vector r) {
  const double angle = length(r);
  const double sinc = angle > 0 ? std::sin(angle) / angle : 1;
  const double half = angle > 0 ? std::sin(angle / 2) / (angle / 2) : 1;
  const Vector across = cross(r, axis);
  return axis + sinc * across + (0.5 * half * half) * cross(r, across);
}

bool is_finite(Vector v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void turn(kernels::Vectors& vectors, const Carriage& by) {
  for (std::size_t i = 0; i < vectors.size(); ++i) vectors.set(i, by.turned(vectors[i]));
}

}  // namespace

Carriage::Carriage(const RigidMotion& motion, double share) {
  const Vector r{share * motion.rotation.x, share * motion.rotation.y, share * motion.rotation.z};
  turned = {rotated({1, 0, 0}, r), rotated({0, 1, 0}, r), rotated({0, 0, 1}, r)};
  about = {motion.about.x, motion.about.y, motion.about.z};
  to = about + share * Vector{motion.translation.x, motion.translation.y, motion.translation.z};
}

void CarriedWay::add(const RigidMotion& motion, double share) {
  const auto of = [&](Vec3 v) { return share * Vector{v.x, v.y, v.z}; };
  const Vector to = {motion.about.x + share * motion.translation.x,
                     motion.about.y + share * motion.translation.y,
                     motion.about.z + share * motion.translation.z};
  moved = moved + of(motion.translation) - cross(of(motion.rotation), to);
  turned = turned + of(motion.rotation);
}

std::uint32_t carry(State& s, const Carriage& by) {
  const Model& model = *s.model;
  s.solved = s.position;  // padding stays at the origin
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (!model.is_particle(slot)) continue;
    const Vector to = by.moved(s.position[slot]);
    if (!is_finite(to)) return slot;
    s.solved.set(slot, to);
  }
  std::swap(s.position, s.solved);
  turn(s.velocity, by);
  s.pins.carry([&](Vector p) { return by.moved(p); }, by.turned);
  s.anchors.carry([&](Vector p) { return by.moved(p); }, by.turned);
  s.bodies.carry(by.turned, by.about, by.to);
  if (s.small_steps) s.small_steps->turn(by.turned);
  return kNoIndex;
}

}  // namespace weft
