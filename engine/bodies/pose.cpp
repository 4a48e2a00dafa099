#include "engine/bodies/pose.h"

#include <cmath>

namespace weft {
namespace {

using kernels::Vector;

Vector turned(const Rotation& q, Vector v) {
  const Vector u{q.x, q.y, q.z};
  const Vector t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

}  // namespace

Rotation product(const Rotation& a, const Rotation& b) {
  const Vector u{a.x, a.y, a.z}, v{b.x, b.y, b.z};
  const Vector w = a.w * v + b.w * u + cross(u, v);
  return {w.x, w.y, w.z, a.w * b.w - dot(u, v)};
}

Rotation inverse(const Rotation& q) { return {-q.x, -q.y, -q.z, q.w}; }

Rotation rotation_by(Vector turn) {
  const double angle = length(turn);
  const double part = angle > 1e-8 ? std::sin(angle / 2) / angle : 0.5;
  return normalized({part * turn.x, part * turn.y, part * turn.z, std::cos(angle / 2)});
}

Vector turn_of(const Rotation& q) {
  const Vector part = q.w < 0 ? Vector{-q.x, -q.y, -q.z} : Vector{q.x, q.y, q.z};
  const double sine = length(part);
  return (sine > 1e-8 ? 2 * std::atan2(sine, std::abs(q.w)) / sine : 2) * part;
}

/// The largest of the four is found first.
Rotation rotation_of(const Turn& turn) {
  const auto& [x, y, z] = turn;
  const double w = 1 + x.x + y.y + z.z;
  if (w > 1) return normalized({y.z - z.y, z.x - x.z, x.y - y.x, w});
  if (x.x >= y.y && x.x >= z.z)
    return normalized({1 + x.x - y.y - z.z, y.x + x.y, z.x + x.z, y.z - z.y});
  if (y.y >= z.z) return normalized({y.x + x.y, 1 - x.x + y.y - z.z, z.y + y.z, z.x - x.z});
  return normalized({z.x + x.z, z.y + y.z, 1 - x.x - y.y + z.z, x.y - y.x});
}

reference::Placement placement_of(const Rotation& q, Vector centre) {
  return {turned(q, {1, 0, 0}), turned(q, {0, 1, 0}), turned(q, {0, 0, 1}), centre};
}

Rotation normalized(const Rotation& q) {
  const double l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / l, q.y / l, q.z / l, q.w / l};
}

PoseTravel::PoseTravel(const Pose& from, const Pose& to)
    : begins_(from.rotation),
      start_{from.position.x, from.position.y, from.position.z},
      way_(Vector{to.position.x, to.position.y, to.position.z} - start_) {
  const Rotation turn = product(to.rotation, inverse(from.rotation));
  const double sign = turn.w < 0 ? -1 : 1;
  const Vector part = sign * Vector{turn.x, turn.y, turn.z};
  const double sine = length(part);
  if (!(sine > 0)) return;
  axis_ = (1 / sine) * part;
  angle_ = 2 * std::atan2(sine, sign * turn.w);
}

reference::Placement PoseTravel::at(double share) const {
  const double half = 0.5 * share * angle_;
  const Vector part = std::sin(half) * axis_;
  const Rotation q = product({part.x, part.y, part.z, std::cos(half)}, begins_);
  return placement_of(q, start_ + share * way_);
}

}  // namespace weft
