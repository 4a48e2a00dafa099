/// The bodies that move by themselves, among those of a cloth.
#include <algorithm>

#include "engine/bodies/bodies.h"
#include "engine/public_vectors.h"

namespace weft {

using kernels::Vector;

/// It is put there, and keeps its velocity.
void Bodies::put(Entry& entry, const Pose& pose) {
  FreeMotion& motion = entry.motion;
  const BodyInertia inertia(entry.mass);
  const Vector spin = inertia.spin(motion.rotation, motion.momentum);
  motion.rotation = pose.rotation;
  motion.momentum = inertia.momentum(pose.rotation, spin);
  motion.centre = placement_of(pose.rotation, to_internal(pose.position))
                      .placed(to_internal(entry.mass.centre));
  motion.past = {};
}

BodyVelocity Bodies::velocity(std::uint32_t id) const {
  const Entry& entry = bodies_[id];
  const FreeMotion& motion = entry.motion;
  return {to_public(motion.velocity),
          to_public(BodyInertia(entry.mass).spin(motion.rotation, motion.momentum))};
}

bool Bodies::set_velocity(std::uint32_t id, const BodyVelocity& velocity) {
  Entry& entry = bodies_[id];
  FreeMotion& motion = entry.motion;
  const Vector linear = to_internal(velocity.linear);
  const Vector momentum =
      BodyInertia(entry.mass).momentum(motion.rotation, to_internal(velocity.angular));
  const bool changes = linear != motion.velocity || momentum != motion.momentum;
  motion.velocity = linear;
  motion.momentum = momentum;
  return changes;
}

bool Bodies::set_force(std::uint32_t id, Vec3 force, Vec3 moment) {
  Entry& entry = bodies_[id];
  const bool changes = to_internal(force) != to_internal(entry.force) ||
                       to_internal(moment) != to_internal(entry.moment);
  entry.force = force;
  entry.moment = moment;
  return changes;
}

/// Those of the last step are written over: their memory is kept.
std::span<const FreeBody> Bodies::free(double friction_of_cloth) {
  std::size_t count = 0;
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    const Entry& entry = bodies_[id];
    if (!entry.is_free()) continue;
    if (count == free_.size()) free_.emplace_back();
    FreeBody& body = free_[count++];
    body.id = id;
    body.shape = entry.shape;
    body.mass = entry.mass;
    body.thickness = entry.thickness;
    body.friction = std::sqrt(entry.friction * friction_of_cloth);
    body.force = to_internal(entry.force);
    body.moment = to_internal(entry.moment);
    body.motion = entry.motion;
  }
  free_.resize(count);
  return free_;
}

void Bodies::take(std::span<const FreeBody> free) {
  for (const FreeBody& body : free) {
    Entry& entry = bodies_[body.id];
    entry.motion = body.motion;
    entry.from = entry.to = pose_of(body.mass, body.motion);
  }
}

double Bodies::fastest() const {
  double fastest = 0;
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    const Entry& entry = bodies_[id];
    if (!entry.is_free()) continue;
    double reach = 0;
    for (const Vector corner : entry.shape->bounds().corners)
      reach = std::max(reach, length(corner - to_internal(entry.mass.centre)));
    const Vector spin = to_internal(velocity(id).angular);
    fastest = std::max(fastest, length(entry.motion.velocity) +
                                    (reach + entry.shape->bounds().radius) * length(spin));
  }
  return fastest;
}

double Bodies::bring_to_rest() {
  double energy = 0;
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    Entry& entry = bodies_[id];
    if (!entry.is_free()) continue;
    FreeMotion& motion = entry.motion;
    energy += 0.5 * (entry.mass.mass * dot(motion.velocity, motion.velocity) +
                     dot(motion.momentum, to_internal(velocity(id).angular)));
    motion.velocity = motion.momentum = {};
  }
  return energy;
}

void Bodies::carry(const Turn& turned, Vector about, Vector to) {
  const Rotation rotation = rotation_of(turned);
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    Entry& entry = bodies_[id];
    if (entry.shape == nullptr || !has_mass(id)) continue;
    FreeMotion& motion = entry.motion;
    motion.centre = to + turned(motion.centre - about);
    motion.rotation = normalized(product(rotation, motion.rotation));
    FreePast& past = motion.past;
    for (Vector* each : {&motion.velocity, &motion.momentum, &past.velocity, &past.momentum,
                         &past.velocity_before, &past.momentum_before, &past.moved, &past.turn})
      *each = turned(*each);
    entry.from = entry.to = pose_of(entry.mass, motion);
  }
}

void Bodies::forget_touching() {
  for (Entry& entry : bodies_) entry.motion.touching.clear();
}

}  // namespace weft
