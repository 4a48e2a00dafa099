#include "tools/program/measure/starts_inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/bodies/body_shape.h"
#include "engine/bodies/pose.h"
#include "tools/scenes/body_moves.h"

namespace weft::tools {
namespace {

std::vector<Vec3> free_particles(const SceneDescription& scene) {
  std::vector<bool> counts(scene.positions.size(), true);
  for (const std::uint32_t particle : scene.fixed) counts[particle] = false;
  for (const std::uint32_t particle : scene.spheres) counts[particle] = false;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i]) places.push_back(scene.positions[i]);
  }
  return places;
}

/// How often a closed surface winds around a point: rays along x, in both directions, go through
/// triangles that face along them and against them. Triangles stand in the cells of a grid over y
/// and z.
class Winding {
 public:
  Winding(std::vector<Vec3> places, std::vector<std::array<std::uint32_t, 3>> triangles)
      : places_(std::move(places)), triangles_(std::move(triangles)) {
    for (const Vec3& p : places_) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    side_ = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles_.size()))));
    cells_.resize(side_ * side_);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) add(t);
  }

  /// Whether both rays leave it, each beyond `depth`.
  bool is_around(Vec3 p, double depth) const {
    if (p.x < low_.x || p.x > high_.x || p.y < low_.y || p.y > high_.y || p.z < low_.z ||
        p.z > high_.z)
      return false;
    // Off the corners and edges of meshes whose numbers are round, which a ray must not meet.
    constexpr double kAside = 1e-9;
    p.y += kAside * 0.7548776662466927 * (high_.y - low_.y);
    p.z += kAside * 0.5698402909980532 * (high_.z - low_.z);
    int before = 0, behind = 0;
    for (const std::uint32_t t : cells_[cell_of(p)]) {
      const auto [facing, x] = met(t, p);
      if (facing == 0 || std::abs(x - p.x) <= depth) continue;
      (x > p.x ? behind : before) += facing;
    }
    return behind > 0 && before < 0;
  }

 private:
  struct Met {
    int facing = 0;  // 1: along x; 0: the ray misses it
    double x = 0;
  };

  std::size_t row_of(double at, double low, double high) const {
    const double share = high > low ? (at - low) / (high - low) : 0;
    const auto row = static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(side_));
    return std::min(row, side_ - 1);
  }
  std::size_t cell_of(Vec3 p) const {
    return row_of(p.y, low_.y, high_.y) * side_ + row_of(p.z, low_.z, high_.z);
  }
  void add(std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t];
    const auto [y0, y1] = std::minmax({places_[a].y, places_[b].y, places_[c].y});
    const auto [z0, z1] = std::minmax({places_[a].z, places_[b].z, places_[c].z});
    for (std::size_t y = row_of(y0, low_.y, high_.y); y <= row_of(y1, low_.y, high_.y); ++y) {
      for (std::size_t z = row_of(z0, low_.z, high_.z); z <= row_of(z1, low_.z, high_.z); ++z)
        cells_[y * side_ + z].push_back(t);
    }
  }
  /// Twice the area of p and the side from a to b, as both triangles along it compute it.
  double area(std::uint32_t a, std::uint32_t b, Vec3 p) const {
    if (a > b) return -area(b, a, p);
    const Vec3 u = places_[a], v = places_[b];
    return (u.y - p.y) * (v.z - p.z) - (u.z - p.z) * (v.y - p.y);
  }
  Met met(std::uint32_t t, Vec3 p) const {
    const auto& [a, b, c] = triangles_[t];
    const double of_a = area(b, c, p), of_b = area(c, a, p), of_c = area(a, b, p);
    const bool along = of_a > 0 && of_b > 0 && of_c > 0, against = of_a < 0 && of_b < 0 && of_c < 0;
    if (!along && !against) return {};
    const double x =
        (of_a * places_[a].x + of_b * places_[b].x + of_c * places_[c].x) / (of_a + of_b + of_c);
    return {along ? 1 : -1, x};
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<Vec3> places_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  Vec3 low_{kFar, kFar, kFar}, high_{-kFar, -kFar, -kFar};
  std::size_t side_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

std::size_t inside_mesh(const SceneBody& body, const TriangleMesh& mesh,
                        const std::vector<Vec3>& particles, double depth) {
  if (mesh.two_sided) return 0;
  const Winding winding(places_at(body, 0), mesh.triangles);
  return static_cast<std::size_t>(
      std::ranges::count_if(particles, [&](Vec3 p) { return winding.is_around(p, depth); }));
}

/// The body was refused elsewhere if it has no shape.
std::size_t inside_solid(const SceneBody& body, const std::vector<Vec3>& particles, double depth) {
  const auto shape = build_shape(body.shape);
  if (!shape) return 0;
  Pose pose = pose_at(body, 0);
  pose.rotation = normalized(pose.rotation);
  const reference::Placement placement = PoseTravel(pose, pose).at(0);
  const reference::Form& form = *shape.value()->form();
  return static_cast<std::size_t>(std::ranges::count_if(particles, [&](Vec3 p) {
    return form.gap(placement.from_place({p.x, p.y, p.z})).gap < -depth;
  }));
}

}  // namespace

std::vector<StartInside> starts_inside(const SceneDescription& scene,
                                       std::span<const SceneBody> bodies, double depth) {
  std::vector<StartInside> all;
  const std::vector<Vec3> particles = free_particles(scene);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto* mesh = std::get_if<TriangleMesh>(&bodies[i].shape);
    const std::size_t count = mesh != nullptr ? inside_mesh(bodies[i], *mesh, particles, depth)
                                              : inside_solid(bodies[i], particles, depth);
    if (count > 0) all.push_back({i, count});
  }
  return all;
}

}  // namespace weft::tools
