#include "tools/studies/hard/body_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

namespace weft::tools::hard {
namespace {

double gap_of_capsule(const Capsule& c, Vec3 y) {
  if (length(c.b - c.a) == 0) return length(y - c.a) - c.radius_a;
  // The distance from the ball at the share s of the segment is convex in s.
  const auto gap_at = [&](double s) {
    const double radius = c.radius_a + s * (c.radius_b - c.radius_a);
    return length(y - (c.a + s * (c.b - c.a))) - radius;
  };
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double third = (high - low) / 3;
    if (gap_at(low + third) < gap_at(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return std::min({gap_at(low), gap_at(0), gap_at(1)});
}

}  // namespace

Solid::Solid(const ShapeDescription& shape) {
  if (const auto* plane = std::get_if<Plane>(&shape)) {
    const double l = length(plane->normal);
    halves_.push_back({(1 / l) * plane->normal, plane->offset / l});
  } else if (const auto* ball = std::get_if<Ball>(&shape)) {
    capsule_ = {ball->centre, ball->centre, ball->radius, ball->radius};
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    capsule_ = *capsule;
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    // Every plane through three points that has all others on one side.
    const std::vector<Vec3>& p = hull->points;
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (std::size_t j = 0; j < p.size(); ++j) {
        for (std::size_t k = 0; k < p.size(); ++k) {
          const Vec3 across = cross(p[j] - p[i], p[k] - p[i]);
          const double l = length(across);
          if (!(l > 1e-12)) continue;
          const Vec3 normal = (1 / l) * across;
          const double offset = dot(normal, p[i]);
          if (std::ranges::all_of(p, [&](Vec3 q) { return dot(normal, q) <= offset + 1e-9; }))
            halves_.push_back({normal, offset});
        }
      }
    }
  }
}

double Solid::gap(Vec3 y, double thickness) const {
  if (halves_.empty()) return gap_of_capsule(capsule_, y) - thickness;
  double gap = -std::numeric_limits<double>::infinity();
  for (const HalfSpace& half : halves_) gap = std::max(gap, dot(half.normal, y) - half.offset);
  return gap - thickness;
}

TrialBody::TrialBody(const ShapeDescription& description, double rubs,
                     std::function<Pose(double)> moves)
    : solid(description), friction(rubs), pose(std::move(moves)) {
  auto built = build_shape(description);
  if (!built) throw std::runtime_error(built.error());
  shape = built.value();
  if (const auto* triangles = std::get_if<TriangleMesh>(&description)) mesh = *triangles;
}

Vec3 in_body(const Pose& pose, Vec3 x) {
  // q* (x - position) q, with t = 2 q x v
  const Rotation& r = pose.rotation;
  const double l = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  const Vec3 q = (-1 / l) * Vec3{r.x, r.y, r.z};
  const Vec3 v = x - pose.position, t = 2.0 * cross(q, v);
  return v + (r.w / l) * t + cross(q, t);
}

double max_penetration(const SceneDescription& scene, const Snapshot& state, const TrialBody& body,
                       const Pose& pose) {
  const std::vector<bool> fixed = fixed_particles(scene);
  const double thickness = body.thickness - body.yields;
  double deepest = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (fixed[i]) continue;
    deepest = std::max(deepest, -body.solid.gap(in_body(pose, state.positions[i]), thickness));
  }
  return deepest;
}

bool went_through(const Snapshot& before, const Snapshot& after, const TrialBody& body,
                  const Pose& from, const Pose& to, double depth) {
  constexpr int kPlaces = 200;
  for (std::size_t i = 0; i < before.positions.size(); ++i) {
    const Vec3 y0 = in_body(from, before.positions[i]), y1 = in_body(to, after.positions[i]);
    const double gap0 = body.solid.gap(y0, 0), gap1 = body.solid.gap(y1, 0);
    if (gap0 < 0 || gap1 < 0) continue;
    // On a way of one metre the gap falls by one metre at most.
    if (gap0 + gap1 - length(y1 - y0) > -2 * depth) continue;
    for (int k = 1; k < kPlaces; ++k) {
      const double share = k / static_cast<double>(kPlaces);
      if (body.solid.gap(y0 + share * (y1 - y0), 0) < -depth) return true;
    }
  }
  return false;
}

}  // namespace weft::tools::hard
