/// Bodies beside a cloth.
#include <string>

#include "engine/bodies/validate_bodies.h"
#include "engine/cpp_interface/cloth_impl.h"
#include "engine/model/rest_lengths.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/validation.h"

namespace weft {
namespace {

Result<void> validate_body(const Bodies& bodies, std::uint32_t id) {
  if (bodies.has(id)) return {};
  return refuse("body", "no such body", std::to_string(id));
}

Result<void> validate_vertices(const Bodies& bodies, std::uint32_t id,
                               std::span<const Vec3> vertices) {
  if (auto r = validate_body(bodies, id); !r) return r;
  const std::size_t count = bodies.vertices(id);
  if (count == 0) return refuse("body", "is no triangle mesh", std::to_string(id));
  if (vertices.size() != count)
    return refuse("vertices", "must be as many as the mesh has, " + std::to_string(count),
                  std::to_string(vertices.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(vertices[i]))
      return refuse(element("vertices", i), "must be finite", text(vertices[i]));
  }
  return {};
}

Result<void> validate_mass(const Bodies& bodies, std::uint32_t id) {
  if (auto r = validate_body(bodies, id); !r) return r;
  if (bodies.has_mass(id)) return {};
  return refuse("body", "has no mass", std::to_string(id));
}

/// A body that moves by itself touches particles alone.
Result<void> validate_width(const Model& model, const Body& body) {
  if (!body.mass || model.has_spheres()) return {};
  if (!body.shape->widths().fit_through(widest_gaps(model), body.thickness)) return {};
  return refuse("mass", "must be of a body that does not fit between the particles of the cloth",
                "a width of " + number(body.shape->widths().least) + " m");
}

}  // namespace

Result<std::uint32_t> Cloth::add_body(const Body& body) {
  if (auto valid = validate(body); !valid) return Error{valid.error()};
  if (auto prepared = prepare_for("body"); !prepared) return Error{prepared.error()};
  if (auto r = validate_width(*impl_->state.model, body); !r) return Error{r.error()};
  impl_->state.wake();
  return impl_->state.bodies.add(body);
}

Result<void> Cloth::move_body(std::uint32_t id, const Pose& pose) {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return r;
  if (auto r = validate(pose); !r) return r;
  if (impl_->state.bodies.has_mass(id))
    return refuse("body", "moves by itself, since it has a mass", std::to_string(id));
  if (impl_->state.bodies.move(id, pose)) impl_->state.wake();
  return {};
}

Result<void> Cloth::place_body(std::uint32_t id, const Pose& pose) {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return r;
  if (auto r = validate(pose); !r) return r;
  if (impl_->state.bodies.place(id, pose)) impl_->state.wake();
  return {};
}

Result<void> Cloth::move_body_vertices(std::uint32_t id, std::span<const Vec3> vertices) {
  if (auto r = validate_vertices(impl_->state.bodies, id, vertices); !r) return r;
  if (impl_->state.bodies.move_vertices(id, vertices)) impl_->state.wake();
  return {};
}

Result<void> Cloth::place_body_vertices(std::uint32_t id, std::span<const Vec3> vertices) {
  if (auto r = validate_vertices(impl_->state.bodies, id, vertices); !r) return r;
  if (impl_->state.bodies.place_vertices(id, vertices)) impl_->state.wake();
  return {};
}

Result<void> Cloth::switch_body(std::uint32_t id, bool on) {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return r;
  if (impl_->state.bodies.switch_on(id, on)) impl_->state.wake();
  return {};
}

Result<void> Cloth::remove_body(std::uint32_t id) {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return r;
  impl_->state.bodies.remove(id);
  impl_->state.wake();
  return {};
}

Result<BodyLoad> Cloth::body_load(std::uint32_t id) const {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return Error{r.error()};
  return impl_->state.bodies.load(id);
}

Result<Pose> Cloth::body_pose(std::uint32_t id) const {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return Error{r.error()};
  return impl_->state.bodies.pose(id);
}

Result<BodyVelocity> Cloth::body_velocity(std::uint32_t id) const {
  if (auto r = validate_mass(impl_->state.bodies, id); !r) return Error{r.error()};
  return impl_->state.bodies.velocity(id);
}

Result<void> Cloth::set_body_velocity(std::uint32_t id, const BodyVelocity& velocity) {
  if (auto r = validate_mass(impl_->state.bodies, id); !r) return r;
  if (!finite(velocity.linear))
    return refuse("velocity.linear", "must be finite", text(velocity.linear));
  if (!finite(velocity.angular))
    return refuse("velocity.angular", "must be finite", text(velocity.angular));
  if (impl_->state.bodies.set_velocity(id, velocity)) impl_->state.wake();
  return {};
}

Result<void> Cloth::set_body_force(std::uint32_t id, Vec3 force, Vec3 moment) {
  if (auto r = validate_mass(impl_->state.bodies, id); !r) return r;
  if (!finite(force)) return refuse("force", "must be finite", text(force));
  if (!finite(moment)) return refuse("moment", "must be finite", text(moment));
  if (impl_->state.bodies.set_force(id, force, moment)) impl_->state.wake();
  return {};
}

std::vector<Torn> Cloth::torn() const { return impl_->state.torn; }

std::vector<std::array<std::uint32_t, 3>> Cloth::surface() const {
  const Model& model = *impl_->state.model;
  std::vector<std::array<std::uint32_t, 3>> triangles = model.surface;
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = model.ordering.particle_at[corner];
  }
  return triangles;
}

std::vector<BodyContact> Cloth::body_contacts() const {
  std::vector<BodyContact> contacts;
  if (impl_->state.settings.solver != Solver::small_steps) return contacts;
  std::vector<BodyTouch> touches;
  impl_->state.small_steps->read_contacts(touches);
  for (const BodyTouch& touch : touches) {
    contacts.push_back({.particle = impl_->state.model->ordering.particle_at[touch.slot],
                        .body = touch.body,
                        .point = to_public(touch.point),
                        .normal = to_public(touch.normal),
                        .push = touch.push});
  }
  return contacts;
}

}  // namespace weft
