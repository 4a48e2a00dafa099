#include "engine/contact/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {

using kernels::Vector;

bool ContactSurfaces::begin(const BodyClock& clock) {
  slots_ = model_.slots();
  largest_thickness_ = 0;
  surface_pairs_.clear();
  std::size_t points = slots_, surfaces = 1;
  const std::size_t surfaces_before = surfaces_.size();
  bool has_other_numbers = false;
  for (std::size_t body = 0; body < clock.bodies().size(); ++body) {
    if (clock.bodies()[body].mesh == nullptr) continue;
    add_cloth();
    ContactSurface& surface = surface_for(clock, body, surfaces);
    if (std::exchange(surface.first_point, static_cast<std::uint32_t>(points)) != points) {
      surface.placing = 0;
      has_other_numbers = true;
    }
    points += clock.bodies()[body].from.size();
    surface_pairs_.push_back({kClothSurface, static_cast<std::uint16_t>(surfaces)});
    ++surfaces;
  }
  touches_itself_ = model_.self_contact.on;
  if (touches_itself_) prepare_for_itself();
  if (empty()) surfaces = 0;
  surfaces_.resize(surfaces);
  if (!has_other_numbers && surfaces == surfaces_before && points == count()) return false;
  surface_of_.clear();
  for (std::uint16_t i = 1; i < surfaces_.size(); ++i)
    surface_of_.insert(surface_of_.end(), surfaces_[i].from.size(), i);
  return true;
}

/// It is there as soon as there is something to touch.
void ContactSurfaces::add_cloth() {
  if (!surfaces_.empty()) return;
  ContactSurface& cloth = surfaces_.emplace_back();
  cloth.triangles = &model_.touched_surface();
  cloth.own_tree = BoxTree(cloth.triangles->in_order);
  shortest_.assign(slots_, std::numeric_limits<double>::infinity());
  for (const auto& [a, b] : cloth.triangles->edges) {
    const double l = length(model_.initial_position[a] - model_.initial_position[b]);
    shortest_[a] = std::min(shortest_[a], l);
    shortest_[b] = std::min(shortest_[b], l);
  }
}

void ContactSurfaces::prepare_for_itself() {
  add_cloth();
  ContactSurface& cloth = surfaces_[kClothSurface];
  cloth.thickness = model_.self_contact.thickness;
  cloth.friction = model_.self_contact.friction;
  largest_thickness_ = std::max(largest_thickness_, cloth.thickness);
  if (!rest_.empty()) return;
  sewn_ = SewnPoints(model_);
  rest_ = RestDistances(model_, cloth.thickness, sewn_);
}

/// The surface of a body, which is the one that was there in the last frame if that had its shape.
ContactSurface& ContactSurfaces::surface_for(const BodyClock& clock, std::size_t body,
                                             std::size_t place) {
  const TravellingBody& b = clock.bodies()[body];
  if (place == surfaces_.size()) surfaces_.emplace_back();
  ContactSurface& surface = surfaces_[place];
  if (surface.shape != b.shape || surface.mesh != b.mesh) {
    const MeshShape& mesh = *b.mesh;
    surface.triangles = &mesh.surface;
    surface.two_sided = mesh.two_sided;
    surface.is_open = mesh.is_open;
    surface.own_tree = {};
    surface.active.make_room(mesh.surface.triangles.size());
    surface.shape = b.shape;
    surface.mesh = b.mesh;
    surface.is_rigid = false;
    surface.placing = 0;
  }
  if (std::exchange(surface.thickness, b.thickness) != b.thickness) surface.placing = 0;
  take_vertices(surface, b);
  surface.body = static_cast<std::uint32_t>(body);
  surface.friction = clock.motions()[body].friction;
  largest_thickness_ = std::max(largest_thickness_, b.thickness);
  return surface;
}

void ContactSurfaces::take_vertices(ContactSurface& surface, const TravellingBody& body) {
  const Vector* of_shape = surface.mesh->vertices.data();
  const bool is_rigid = body.from.data() == of_shape && body.to.data() == of_shape;
  surface.from = body.from;
  surface.to = body.to;
  if (is_rigid && surface.is_rigid) return;
  surface.is_rigid = is_rigid;
  surface.longest = 0;
  if (is_rigid) {
    surface.extent = surface.tree().box();
    return;
  }
  if (surface.own_tree.empty()) surface.own_tree = BoxTree(surface.triangles->in_order);
  surface.extent = Box::none();
  for (std::size_t i = 0; i < body.from.size(); ++i) {
    const Vector way = body.to[i] - body.from[i];
    surface.longest = std::max(surface.longest, dot(way, way));
    surface.extent.add(Box::at(body.from[i]));
    surface.extent.add(Box::at(body.to[i]));
  }
  surface.longest = std::sqrt(surface.longest);
}

std::size_t ContactSurfaces::bytes() const {
  std::size_t bytes =
      bytes_of(surfaces_) + bytes_of(surface_pairs_) + bytes_of(surface_of_) + bytes_of(shortest_);
  for (const ContactSurface& surface : surfaces_)
    bytes += surface.own_tree.bytes() + surface.normals.bytes() + bytes_of(surface.active);
  return bytes;
}

}  // namespace weft
