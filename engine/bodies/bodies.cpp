#include "engine/bodies/bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"

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
                     .friction = body.friction});
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
  are_others_ = are_others_ || changes;
  return changes;
}

bool Bodies::switch_on(std::uint32_t id, bool on) {
  const bool changes = std::exchange(bodies_[id].is_on, on) != on;
  are_others_ = are_others_ || changes;
  return changes;
}

std::span<const TravellingBody> Bodies::travelling(double friction_of_cloth) {
  travelling_.clear();
  for (std::uint32_t id = 0; id < bodies_.size(); ++id) {
    const Entry& entry = bodies_[id];
    if (entry.shape == nullptr || !entry.is_on) continue;
    travelling_.push_back({.id = id,
                           .shape = entry.shape,
                           .travel = PoseTravel(entry.from, entry.to),
                           .thickness = entry.thickness,
                           .friction = std::sqrt(entry.friction * friction_of_cloth)});
  }
  return travelling_;
}

bool Bodies::any() const {
  return std::ranges::any_of(bodies_, [](const Entry& e) { return e.shape != nullptr; });
}

bool Bodies::moving() const {
  const auto is_under_way = [](const Entry& e) { return e.moves || e.moved; };
  return are_others_ || std::ranges::any_of(bodies_, is_under_way);
}

void Bodies::arrive(std::span<const BodyImpulse> impulses, double dt) {
  are_others_ = false;
  for (Entry& entry : bodies_) {
    entry.from = entry.to;
    entry.moved = std::exchange(entry.moves, false);
    entry.load = {};
  }
  for (const BodyImpulse& impulse : impulses) {
    bodies_[impulse.id].load = {over_time(impulse.linear, dt), over_time(impulse.angular, dt)};
  }
}

std::size_t Bodies::bytes() const { return bytes_of(bodies_) + bytes_of(travelling_); }

}  // namespace weft
