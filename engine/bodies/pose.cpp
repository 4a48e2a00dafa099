#include "engine/bodies/pose.h"

#include <cmath>

namespace weft {
namespace {

using kernels::Vector;

/// First b, then a.
Rotation product(const Rotation& a, const Rotation& b) {
  const Vector u{a.x, a.y, a.z}, v{b.x, b.y, b.z};
  const Vector w = a.w * v + b.w * u + cross(u, v);
  return {w.x, w.y, w.z, a.w * b.w - dot(u, v)};
}

Vector turned(const Rotation& q, Vector v) {
  const Vector u{q.x, q.y, q.z};
  const Vector t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

}  // namespace

Rotation normalized(const Rotation& q) {
  const double l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / l, q.y / l, q.z / l, q.w / l};
}

PoseTravel::PoseTravel(const Pose& from, const Pose& to)
    : begins_(from.rotation),
      start_{from.position.x, from.position.y, from.position.z},
      way_(Vector{to.position.x, to.position.y, to.position.z} - start_) {
  const Rotation& q = from.rotation;
  const Rotation turn = product(to.rotation, {-q.x, -q.y, -q.z, q.w});
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
  return {turned(q, {1, 0, 0}), turned(q, {0, 1, 0}), turned(q, {0, 0, 1}), start_ + share * way_};
}

}  // namespace weft
