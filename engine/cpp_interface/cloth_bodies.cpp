/// Bodies beside a cloth.
#include <string>

#include "engine/bodies/validate_bodies.h"
#include "engine/cpp_interface/cloth_impl.h"
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

}  // namespace

Result<std::uint32_t> Cloth::add_body(const Body& body) {
  if (auto valid = validate(body); !valid) return Error{valid.error()};
  if (auto prepared = prepare_for("body"); !prepared) return Error{prepared.error()};
  impl_->state.wake();
  return impl_->state.bodies.add(body);
}

Result<void> Cloth::move_body(std::uint32_t id, const Pose& pose) {
  if (auto r = validate_body(impl_->state.bodies, id); !r) return r;
  if (auto r = validate(pose); !r) return r;
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
