#include "engine/bodies/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace weft {
namespace {

using kernels::Vector;
using Triangle = std::array<std::uint32_t, 3>;

/// A share of the extent: a point that is no farther outside does not change the hull.
constexpr double kRounding = 1e-10;

/// Points are added one after the other: the faces that a point sees go, and it is joined to their
/// border.
class HullBuilder {
 public:
  explicit HullBuilder(std::span<const Vector> points) : points_(points) {
    for (const Vector p : points) extent_ = std::max(extent_, length(p - points[0]));
  }

  std::vector<Triangle> build() {
    if (!begin()) return {};
    for (std::uint32_t p = 0; p < points_.size(); ++p) add(p);
    std::vector<Triangle> triangles;
    for (const Face& face : faces_) triangles.push_back(face.corners);
    return triangles;
  }

 private:
  struct Face {
    Triangle corners{};
    Vector normal{};
    double offset = 0;
  };

  Face face(Triangle corners) const {
    const auto [a, b, c] = corners;
    const Vector across = cross(points_[b] - points_[a], points_[c] - points_[a]);
    const Vector normal = kernels::direction(across, length(across));
    return {corners, normal, dot(normal, points_[a])};
  }
  double height(const Face& face, std::uint32_t p) const {
    return dot(face.normal, points_[p]) - face.offset;
  }
  template <class Measure>
  std::uint32_t farthest(Measure&& measure) const {
    std::uint32_t most = 0;
    for (std::uint32_t p = 1; p < points_.size(); ++p) {
      if (measure(p) > measure(most)) most = p;
    }
    return most;
  }
  /// A tetrahedron of points that are far apart.
  bool begin() {
    if (points_.size() < 4) return false;
    const double least = kRounding * extent_;
    const std::uint32_t a = 0;
    const std::uint32_t b = farthest([&](auto p) { return length(points_[p] - points_[a]); });
    const Vector along = points_[b] - points_[a];
    if (!(length(along) > least)) return false;
    const auto off_line = [&](std::uint32_t p) {
      return length(cross(points_[p] - points_[a], along)) / length(along);
    };
    const std::uint32_t c = farthest(off_line);
    if (!(off_line(c) > least)) return false;
    const Face base = face({a, b, c});
    const std::uint32_t d = farthest([&](auto p) { return std::abs(height(base, p)); });
    if (!(std::abs(height(base, d)) > least)) return false;
    const bool above = height(base, d) > 0;
    const Triangle bottom = above ? Triangle{a, c, b} : Triangle{a, b, c};
    faces_.push_back(face(bottom));
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = bottom[static_cast<std::size_t>(i)];
      const std::uint32_t to = bottom[static_cast<std::size_t>((i + 1) % 3)];
      faces_.push_back(face({to, from, d}));
    }
    return true;
  }
  void add(std::uint32_t p) {
    const auto sees = [&](const Face& face) { return height(face, p) > kRounding * extent_; };
    const auto seen =
        std::partition(faces_.begin(), faces_.end(), [&](const Face& face) { return !sees(face); });
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (auto it = seen; it != faces_.end(); ++it) {
      for (std::size_t i = 0; i < 3; ++i) edges.emplace(it->corners[i], it->corners[(i + 1) % 3]);
    }
    faces_.erase(seen, faces_.end());
    for (const auto& [from, to] : edges) {
      if (!edges.contains({to, from})) faces_.push_back(face({from, to, p}));
    }
  }

  std::span<const Vector> points_;
  double extent_ = 0;
  std::vector<Face> faces_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const kernels::Vector> points) {
  return HullBuilder(points).build();
}

}  // namespace weft
