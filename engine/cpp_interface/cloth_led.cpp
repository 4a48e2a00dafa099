/// A cloth is led: fixed particles and anchors are moved, or all of it is carried.
#include <algorithm>
#include <string>

#include "engine/cpp_interface/cloth_impl.h"
#include "engine/model/change.h"
#include "engine/model/validate.h"
#include "engine/step/carry.h"
#include "engine/validation.h"

namespace weft {
namespace {

bool is_pin(const Model& model, std::uint32_t particle) {
  if (particle >= model.particles) return false;
  const std::uint32_t slot = model.ordering.slot_of[particle];
  return model.inverse_mass[slot] == 0 && !model.is_attached(slot);
}

Result<void> validate_pin(const Model& model, const std::string& field, std::uint32_t particle) {
  if (is_pin(model, particle)) return {};
  if (auto r = validate_particle(field, particle, model.particles); !r) return r;
  return refuse(field, "is not fixed", std::to_string(particle));
}

Result<void> validate_pins(const Model& model, std::span<const std::uint32_t> particles,
                           std::span<const Vec3> to) {
  if (auto r = validate_vectors("positions", to, particles.size()); !r) return r;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!is_pin(model, particles[i]))
      return validate_pin(model, element("particles", i), particles[i]);
  }
  return {};
}

bool is_identity(const RigidMotion& motion) {
  const auto is_none = [](Vec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; };
  return is_none(motion.translation) && is_none(motion.rotation);
}

Result<void> take_along(State& s, const RigidMotion& motion, double share) {
  s.wake();
  const std::uint32_t lost = carry(s, Carriage(motion, share));
  if (lost == kNoIndex) return {};
  return Error{"motion: takes a particle out of the range of numbers (" +
               std::to_string(s.model->ordering.particle_at[lost]) + ")"};
}

}  // namespace

Result<void> Cloth::move_fixed(std::uint32_t particle, Vec3 position) {
  if (auto r = validate_pin(*impl_->state.model, "particle", particle); !r) return r;
  if (auto r = validate_vector("position", particle, position); !r) return r;
  return move_fixed({&particle, 1}, {&position, 1});
}

Result<void> Cloth::move_fixed(std::span<const std::uint32_t> particles,
                               std::span<const Vec3> positions) {
  if (auto r = validate_pins(*impl_->state.model, particles, positions); !r) return r;
  if (particles.empty()) return {};
  impl_->state.pins.watch(*impl_->state.model, impl_->state.position);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    impl_->set(impl_->state.position, particles[i], positions[i]);
  }
  return {};
}

Result<void> Cloth::place_fixed(std::uint32_t particle, Vec3 position) {
  if (auto r = validate_pin(*impl_->state.model, "particle", particle); !r) return r;
  if (auto r = validate_vector("position", particle, position); !r) return r;
  return place_fixed({&particle, 1}, {&position, 1});
}

Result<void> Cloth::place_fixed(std::span<const std::uint32_t> particles,
                                std::span<const Vec3> positions) {
  if (auto r = validate_pins(*impl_->state.model, particles, positions); !r) return r;
  if (particles.empty()) return {};
  impl_->state.pins.teleport(*impl_->state.model, particles, positions, impl_->state.position);
  impl_->state.displaced = true;
  impl_->state.wake();
  return {};
}

Result<void> Cloth::move_anchors(std::span<const Vec3> points, std::span<const Vec3> normals) {
  if (auto r = validate_anchor_move(*impl_->state.model, points, normals); !r) return r;
  impl_->state.anchors.move(points, normals);
  if (impl_->state.anchors.moving()) impl_->state.wake();
  return {};
}

Result<void> Cloth::limit_anchors(std::span<const AnchorLimit> limits) {
  const Model& model = *impl_->state.model;
  if (auto r = validate_anchor_limits(model, limits); !r) return r;
  bool changes_sides = false;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const bool was_attached = model.anchors.limits[i].most == 0;
    changes_sides = changes_sides || was_attached != (limits[i].max_distance == 0);
  }
  if (changes_sides) {
    auto changed = impl_->going_on(with_anchor_distances(model, limits));
    if (!changed) return Error{changed.error()};
    impl_ = std::move(changed).value();
  }
  const auto same = [](const AnchorLimit& a, const AnchorLimit& b) {
    return a.max_distance == b.max_distance && a.backstop == b.backstop;
  };
  if (!std::ranges::equal(limits, impl_->state.anchors.limits(), same)) impl_->state.wake();
  impl_->state.anchors.limit(limits);
  return {};
}

Result<void> Cloth::limit_anchor(std::uint32_t anchor, const AnchorLimit& limit) {
  if (auto r = validate_anchor_limit(*impl_->state.model, anchor, limit); !r) return r;
  std::vector<AnchorLimit> limits = impl_->state.anchors.limits();
  limits[anchor] = limit;
  return limit_anchors(limits);
}

Result<void> Cloth::scale_anchors(double scale) {
  if (auto r = validate_not_negative("scale", scale); !r) return r;
  impl_->state.anchors.scale(scale);
  if (impl_->state.anchors.moving()) impl_->state.wake();
  return {};
}

Result<void> Cloth::release_seams(std::span<const std::uint32_t> seams) {
  State& s = impl_->state;
  if (auto r = validate_seams(*s.model, seams); !r) return r;
  for (const std::uint32_t seam : seams) {
    if (s.seams.release(seam)) s.wake();
  }
  return {};
}

Result<void> Cloth::close_seams(std::span<const std::uint32_t> seams) {
  State& s = impl_->state;
  if (auto r = validate_seams(*s.model, seams); !r) return r;
  for (const std::uint32_t seam : seams) {
    if (s.seams.close(seam, *s.model, s.position, s.settings.contact_tolerance)) s.wake();
  }
  return {};
}

Result<void> Cloth::carry(const RigidMotion& motion, double share) {
  if (auto r = validate_motion(motion, share); !r) return r;
  if (share == 0 || is_identity(motion)) return {};
  if (auto r = take_along(impl_->state, motion, share); !r) return r;
  impl_->state.way.add(motion, share);
  return {};
}

Result<void> Cloth::teleport(const RigidMotion& motion) {
  if (auto r = validate_motion(motion, 1); !r) return r;
  return take_along(impl_->state, motion, 1);
}

}  // namespace weft
