#include "engine/contact/points.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

/// The origin changes seldom.
Vector rounded(Vector v) {
  const auto round = [](double x) {
    return tuning::kContactGrid * std::round(x / tuning::kContactGrid);
  };
  return {round(v.x), round(v.y), round(v.z)};
}

/// Of two places, from the origin, and all that is within `reach` of the way between them.
Box box_around(Vector a, Vector b, double reach) {
  const auto low = [&](double x, double y) { return static_cast<float>(std::min(x, y) - reach); };
  const auto high = [&](double x, double y) { return static_cast<float>(std::max(x, y) + reach); };
  return {{low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)},
          {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)}};
}

}  // namespace

void ContactPoints::begin(const BodyClock& clock) {
  slots_ = model_.slots();
  largest_thickness_ = 0;
  surface_pairs_.clear();
  std::size_t points = slots_, count = 1;
  for (std::size_t body = 0; body < clock.bodies().size(); ++body) {
    if (clock.bodies()[body].shape->mesh() == nullptr) continue;
    add_cloth();
    ContactSurface& surface = surface_for(clock, body, count);
    surface.first_point = static_cast<std::uint32_t>(points);
    points += clock.bodies()[body].from.size();
    surface_pairs_.push_back({kClothSurface, static_cast<std::uint16_t>(count)});
    ++count;
  }
  if (surface_pairs_.empty()) count = 0;
  has_wide_boxes_ = has_wide_boxes_ && count == surfaces_.size();
  surfaces_.resize(count);
  if (count == 0) return;
  for (auto* vectors : {&start_, &end_}) vectors->resize(points);
  for (auto* vectors : {&from_, &to_}) vectors->resize(points - slots_);
  for (auto* quads : {&start_quads_, &way_quads_, &place_quads_}) quads->resize(4 * points);
  box_.resize(points);
  wide_box_.resize(points);
  surface_of_.clear();
  for (std::uint16_t i = 1; i < count; ++i) {
    const std::size_t vertices = clock.bodies()[surfaces_[i].body].from.size();
    surface_of_.insert(surface_of_.end(), vertices, i);
  }
}

/// It is there as soon as there is something to touch.
void ContactPoints::add_cloth() {
  if (!surfaces_.empty()) return;
  ContactSurface& cloth = surfaces_.emplace_back();
  cloth.triangles = &model_.touched_surface();
  cloth.tree = BoxTree(cloth.triangles->in_order);
}

/// The surface of a body, which is the one that was there in the last frame if that had its shape.
ContactSurface& ContactPoints::surface_for(const BodyClock& clock, std::size_t body,
                                           std::size_t place) {
  const TravellingBody& b = clock.bodies()[body];
  if (place == surfaces_.size()) surfaces_.emplace_back();
  ContactSurface& surface = surfaces_[place];
  if (surface.shape != b.shape) {
    const MeshShape& mesh = *b.shape->mesh();
    surface.triangles = &mesh.surface;
    surface.two_sided = mesh.two_sided;
    surface.tree = BoxTree(mesh.surface.in_order);
    surface.shape = b.shape;
    has_wide_boxes_ = false;
  }
  surface.body = static_cast<std::uint32_t>(body);
  surface.thickness = b.thickness;
  surface.friction = clock.motions()[body].friction;
  largest_thickness_ = std::max(largest_thickness_, b.thickness);
  return surface;
}

/// Whether bodies are where they were when the last interval began.
void ContactPoints::note_moves(const BodyClock& clock) {
  const double share = clock.share_after(0);
  for (ContactSurface& surface : of_bodies()) {
    const TravellingBody& body = clock.bodies()[surface.body];
    const reference::Placement at = body.travel.at(share);
    surface.has_moved = false;
    for (std::size_t i = 0; i < body.from.size() && !surface.has_moved; ++i) {
      const Vector d = clock.vertex(surface.body, i, at, share) - start_[surface.first_point + i];
      surface.has_moved = dot(d, d) > 0;
    }
  }
}

/// Of all bodies, when some substeps from now are over.
void ContactPoints::place_vertices(const BodyClock& clock, int substeps,
                                   std::vector<Vector>& to) const {
  const double share = clock.share_after(substeps);
  for (const ContactSurface& surface : of_bodies()) {
    const TravellingBody& body = clock.bodies()[surface.body];
    const reference::Placement at = body.travel.at(share);
    for (std::size_t i = 0; i < body.from.size(); ++i)
      to[surface.first_point + i] = clock.vertex(surface.body, i, at, share);
  }
}

void ContactPoints::begin_interval(const ContactParticles& cloth, const BodyClock& clock,
                                   int substeps) {
  note_moves(clock);
  place_vertices(clock, 0, start_);
  place_vertices(clock, substeps, end_);
  Vector sum{};
  double particles = 0;
  for (std::uint32_t slot = 0; slot < slots_; ++slot) {
    if (!model_.is_particle(slot)) continue;
    const Vector x = cloth.position(slot);
    start_[slot] = clock.stands() ? x : cloth.start(slot);
    end_[slot] = start_[slot] + substeps * (x - start_[slot]);
    sum = sum + start_[slot];
    ++particles;
  }
  const Vector origin = rounded((1 / std::max(1.0, particles)) * sum);
  has_wide_boxes_ = has_wide_boxes_ && length(origin - origin_) == 0;
  origin_ = origin;
  double farthest = 0;
  for (std::size_t point = 0; point < start_.size(); ++point) {
    const Vector from = start_[point] - origin_;
    if (point < slots_) farthest = std::max(farthest, dot(from, from));
    write(start_quads_, point, from);
    write(way_quads_, point, end_[point] - start_[point]);
  }
  rounding_ = static_cast<float>(0x1p-21 * std::sqrt(farthest));
  find_reach();
  write_boxes();
  for (ContactSurface& surface : of_bodies())
    surface.normals.begin(*surface.triangles, &start_[surface.first_point], !surface.has_moved);
}

double ContactPoints::fastest(const BodyClock& clock) const {
  double fastest = 0;
  for (const ContactSurface& surface : of_bodies()) {
    const TravellingBody& body = clock.bodies()[surface.body];
    const reference::BodyMotion& motion = clock.motions()[surface.body];
    double farthest = 0, longest = 0;
    for (std::size_t i = 0; i < body.from.size(); ++i) {
      const Vector way = body.to[i] - body.from[i];
      farthest = std::max(farthest, dot(body.from[i], body.from[i]));
      longest = std::max(longest, dot(way, way));
    }
    const double by_pose = length(motion.velocity) + length(motion.spin) * std::sqrt(farthest);
    fastest = std::max(fastest, by_pose + std::sqrt(longest) / clock.time());
  }
  return fastest;
}

void ContactPoints::find_reach() {
  const auto way_of = [&](std::uint32_t point) { return length(way(point)); };
  double of_bodies = 0;
  for (auto point = static_cast<std::uint32_t>(slots_); point < start_.size(); ++point)
    of_bodies = std::max(of_bodies, way_of(point));
  ways_.resize(slots_);
  reach_.resize(slots_);
  for (std::uint32_t slot = 0; slot < slots_; ++slot) ways_[slot] = reach_[slot] = way_of(slot);
  for (const auto& [a, b] : cloth().edges) {
    reach_[a] = std::max(reach_[a], ways_[b]);
    reach_[b] = std::max(reach_[b], ways_[a]);
  }
  largest_reach_ = 0;
  for (double& reach : reach_) {
    reach = tuning::kContactReach * std::max(reach, of_bodies) +
            tuning::kContactSpare * largest_thickness_;
    largest_reach_ = std::max(largest_reach_, reach);
  }
}

void ContactPoints::write_boxes() {
  const double rounding = static_cast<double>(rounding_);
  for (std::size_t point = 0; point < start_.size(); ++point) {
    const double reach = point < slots_
                             ? reach_[point]
                             : surface_of(static_cast<std::uint32_t>(point)).thickness + rounding;
    box_[point] = box_around(start_[point] - origin_, end_[point] - origin_, reach);
  }
}

/// If the point goes on as in this interval it holds for kContactWide of them.
Box ContactPoints::wide_box_around(std::size_t point) const {
  const Vector from = start_[point] - origin_, way = end_[point] - start_[point];
  const double spare = tuning::kContactReach * length(way);
  const double reach = point < slots_ ? tuning::kContactWideReach * reach_[point] +
                                            tuning::kContactWideSpare * largest_thickness_
                                      : surface_of(static_cast<std::uint32_t>(point)).thickness +
                                            2 * static_cast<double>(rounding_);
  return box_around(from, from + tuning::kContactWide * way, reach + spare);
}

void ContactPoints::widen_boxes() {
  for (std::size_t point = 0; point < start_.size(); ++point)
    wide_box_[point] = wide_box_around(point);
  has_wide_boxes_ = true;
}

void ContactPoints::place_vertices_asked(const BodyClock& clock) {
  for (const std::uint32_t point : asked_) {
    if (is_of_cloth(point)) continue;
    const ContactSurface& surface = surface_of(point);
    const reference::BodyMotion& motion = clock.motions()[surface.body];
    const std::uint32_t vertex = point - surface.first_point;
    from_[point - slots_] = clock.vertex(surface.body, vertex, motion.from, clock.share_after(-1));
    to_[point - slots_] = clock.vertex(surface.body, vertex, motion.to, clock.share_after(0));
    set_place(point, to_[point - slots_]);
  }
}

void ContactPoints::read_cloth(const ContactParticles& cloth) {
  for (const std::uint32_t point : asked_) {
    if (is_of_cloth(point)) set_place(point, cloth.position(point));
  }
}

void ContactPoints::measure_moves(const ContactParticles& cloth, const BodyClock& clock) {
  place_vertices(clock, 0, end_);
  for (std::uint32_t slot = 0; slot < slots_; ++slot) {
    if (model_.is_particle(slot)) end_[slot] = cloth.position(slot);
  }
  for (std::size_t point = 0; point < start_.size(); ++point)
    write(way_quads_, point, end_[point] - start_[point]);
}

bool ContactPoints::holds_end(std::uint32_t point) const { return holds(point, end_[point]); }

bool ContactPoints::hold(const ContactParticles& cloth) const {
  for (std::uint32_t slot = 0; slot < slots_; ++slot) {
    if (model_.is_particle(slot) && !holds(slot, cloth.position(slot))) return false;
  }
  return true;
}

bool ContactPoints::holds(std::uint32_t point, Vector place) const {
  const Vector x = place - origin_;
  const auto holds = [&](double at, std::size_t k) {
    return at >= static_cast<double>(box_[point].low[k]) &&
           at <= static_cast<double>(box_[point].high[k]);
  };
  return holds(x.x, 0) && holds(x.y, 1) && holds(x.z, 2);
}

void ContactPoints::take_way_in(std::uint32_t point) {
  box_[point].add(box_around(start_[point] - origin_, end_[point] - origin_, largest_thickness_));
}

void ContactPoints::set_end(std::uint32_t point, Vector x) {
  end_[point] = x;
  write(way_quads_, point, x - start_[point]);
}

std::size_t ContactPoints::bytes() const {
  std::size_t bytes = bytes_of(surfaces_) + bytes_of(surface_pairs_) + bytes_of(surface_of_) +
                      bytes_of(start_) + bytes_of(end_) + bytes_of(reach_) + bytes_of(ways_) +
                      bytes_of(box_) + bytes_of(wide_box_) + bytes_of(start_quads_) +
                      bytes_of(way_quads_) + bytes_of(place_quads_) + bytes_of(asked_) +
                      bytes_of(from_) + bytes_of(to_);
  for (const ContactSurface& surface : surfaces_)
    bytes += surface.tree.bytes() + surface.normals.bytes();
  return bytes;
}

}  // namespace weft
