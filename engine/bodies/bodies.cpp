#include "engine/bodies/bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bodies/validate_bodies.h"
#include "engine/bytes_of.h"
#include "engine/public_vectors.h"

namespace weft {
namespace {

Pose prepared(const Pose& pose) { return {pose.position, normalized(pose.rotation)}; }

bool same(const Pose& a, const Pose& b) {
  const auto of = [](const Pose& p) {
    const auto& [x, q] = p;
    return std::array{x.x, x.y, x.z, q.x, q.y, q.z, q.w};
  };
  return of(a) == of(b);
}

Vec3 over_time(kernels::Vector v, double dt) { return {-v.x / dt, -v.y / dt, -v.z / dt}; }

}  // namespace

std::uint32_t Bodies::add(const Body& body) {
  const Pose pose = prepared(body.pose);
  bodies_.push_back({.shape = body.shape,
                     .from = pose,
                     .to = pose,
                     .thickness = body.thickness,
                     .friction = body.friction,
                     .mass = body.mass.value_or(BodyMass{})});
  if (body.mass) put(bodies_.back(), pose);
  are_others_ = true;
  return static_cast<std::uint32_t>(bodies_.size() - 1);
}

void Bodies::remove(std::uint32_t id) {
  bodies_[id] = {.shape = nullptr};
  are_others_ = true;
}

bool Bodies::move(std::uint32_t id, const Pose& pose) {
  Entry& entry = bodies_[id];
  const Pose to = prepared(pose);
  const bool changes = !same(to, entry.to);
  entry.to = to;
  entry.moves = !same(entry.from, to);
  return changes;
}

bool Bodies::place(std::uint32_t id, const Pose& pose) {
  Entry& entry = bodies_[id];
  const Pose to = prepared(pose);
  const bool changes = !same(to, entry.from) || !same(to, entry.to);
  entry.from = entry.to = to;
  entry.moves = false;
  if (has_mass(id)) put(entry, to);
  are_others_ = are_others_ || changes;
  return changes;
}

bool Bodies::move_vertices(std::uint32_t id, std::span<const Vec3> to) {
  Entry& entry = bodies_[id];
  const std::vector<kernels::Vector>& first = entry.shape->mesh()->vertices;
  if (entry.vertices_from.empty()) entry.vertices_from = entry.vertices_to = first;
  bool changes = false, moves = false;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const kernels::Vector at{to[i].x, to[i].y, to[i].z};
    changes = changes || at != entry.vertices_to[i];
    moves = moves || at != entry.vertices_from[i];
    entry.vertices_to[i] = at;
  }
  entry.deforms = moves;
  return changes;
}

bool Bodies::place_vertices(std::uint32_t id, std::span<const Vec3> at) {
  const bool changes = move_vertices(id, at);
  Entry& entry = bodies_[id];
  const bool jumps = std::exchange(entry.deforms, false);
  entry.vertices_from = entry.vertices_to;
  are_others_ = are_others_ || jumps;
  return changes || jumps;
}

std::size_t Bodies::vertices(std::uint32_t id) const {
  const MeshShape* mesh = bodies_[id].shape->mesh();
  return mesh != nullptr ? mesh->vertices.size() : 0;
}

bool Bodies::switch_on(std::uint32_t id, bool on) {
  const bool changes = std::exchange(bodies_[id].is_on, on) != on;
  are_others_ = are_others_ || changes;
  return changes;
}

/// A body that fits between the particles of the cloth touches its edges and faces.
const MeshShape* Bodies::mesh_of(const Entry& entry, const Gaps& gaps) {
  const BodyShape& shape = *entry.shape;
  if (shape.thin() == nullptr) return shape.mesh();
  return shape.widths().fit_through(gaps, entry.thickness) ? shape.thin() : nullptr;
}

std::span<const TravellingBody> Bodies::travelling(double friction_of_cloth, const Gaps& gaps) {
  travelling_.clear();
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    const Entry& entry = bodies_[id];
    if (entry.shape == nullptr || !entry.is_on || has_mass(id)) continue;
    const MeshShape* mesh = mesh_of(entry, gaps);
    const auto vertices = [&](const std::vector<kernels::Vector>& given) {
      if (mesh == nullptr) return std::span<const kernels::Vector>{};
      return std::span<const kernels::Vector>(given.empty() ? mesh->vertices : given);
    };
    travelling_.push_back({.id = id,
                           .shape = entry.shape,
                           .travel = PoseTravel(entry.from, entry.to),
                           .mesh = mesh,
                           .from = vertices(entry.vertices_from),
                           .to = vertices(entry.vertices_to),
                           .thickness = entry.thickness + (mesh != nullptr ? mesh->radius : 0),
                           .friction = std::sqrt(entry.friction * friction_of_cloth)});
  }
  return travelling_;
}

bool Bodies::ask_for_gaps() const {
  return std::ranges::any_of(bodies_, [](const Entry& e) {
    return e.shape != nullptr && e.shape->thin() != nullptr && !(e.mass.mass > 0);
  });
}

bool Bodies::any() const {
  return std::ranges::any_of(bodies_, [](const Entry& e) { return e.shape != nullptr; });
}

bool Bodies::are_valid() const {
  const auto is_finite = [](kernels::Vector v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const auto is_valid_motion = [&](const Entry& e) {
    const auto& [centre, rotation, velocity, momentum, past, touching] = e.motion;
    const kernels::Vector all[] = {centre,
                                   velocity,
                                   momentum,
                                   past.velocity,
                                   past.momentum,
                                   past.velocity_before,
                                   past.momentum_before,
                                   past.moved,
                                   past.turn,
                                   to_internal(e.force),
                                   to_internal(e.moment)};
    return std::ranges::all_of(all, is_finite) && validate(Pose{{}, rotation});
  };
  const auto is_valid = [&](const Entry& e) {
    if (e.shape == nullptr) return true;
    const std::size_t count = e.shape->mesh() != nullptr ? e.shape->mesh()->vertices.size() : 0;
    const bool are_given = !e.vertices_from.empty() || !e.vertices_to.empty();
    const bool are_as_many = e.vertices_from.size() == count && e.vertices_to.size() == count;
    return (!are_given || are_as_many) && std::ranges::all_of(e.vertices_from, is_finite) &&
           std::ranges::all_of(e.vertices_to, is_finite) &&
           validate(Body{e.shape, e.to, e.thickness, e.friction,
                         e.mass.mass != 0 ? std::optional(e.mass) : std::nullopt}) &&
           validate(e.from) && is_valid_motion(e);
  };
  return std::ranges::all_of(bodies_, is_valid);
}

bool Bodies::moving() const {
  const auto is_under_way = [](const Entry& e) { return e.moves || e.deforms || e.moved; };
  return are_others_ || std::ranges::any_of(bodies_, is_under_way);
}

void Bodies::arrive(std::span<const BodyImpulse> impulses, double dt) {
  are_others_ = false;
  for (Entry& entry : bodies_) {
    entry.from = entry.to;
    if (entry.deforms) entry.vertices_from = entry.vertices_to;
    entry.moved = entry.moves || entry.deforms;
    entry.moves = entry.deforms = false;
    entry.load = {};
  }
  for (const BodyImpulse& impulse : impulses) {
    bodies_[impulse.id].load = {over_time(impulse.linear, dt), over_time(impulse.angular, dt)};
  }
}

std::size_t Bodies::bytes() const {
  std::size_t bytes = bytes_of(bodies_) + bytes_of(travelling_);
  for (const Entry& entry : bodies_)
    bytes += bytes_of(entry.vertices_from) + bytes_of(entry.vertices_to) +
             bytes_of(entry.motion.touching);
  return bytes + bytes_of(free_);
}

}  // namespace weft
