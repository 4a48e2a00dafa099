#include "engine/mesh/rays.h"

#include <algorithm>

#include "engine/mesh/corners.h"
#include "engine/mesh/pair_key.h"

namespace weft::mesh {
namespace {

constexpr std::size_t kMostRays = 3;

using CornersAround = std::span<const CornerOfFace>;

/// One side of the ring around a particle, in places from there.
struct RingSide {
  std::uint32_t a = 0, b = 0;
  Vec3 from, to;
};

struct Ray {
  Stencil stencil;
  double beside = 0;       ///< how much it reads of the curvature across it
  std::uint64_t ends = 0;  ///< pair_key of both, the nearer corner of the second
};

std::vector<RingSide> ring_of(const std::vector<Face>& faces, CornersAround around) {
  std::vector<RingSide> ring;
  for (const auto& [f, corner] : around) {
    const Face& face = faces[f];
    const Vec3 middle = face.places[corner];
    for (std::size_t i = face.next(corner); i != face.previous(corner); i = face.next(i)) {
      const std::size_t j = face.next(i);
      ring.push_back(
          {face.particles[i], face.particles[j], face.places[i] - middle, face.places[j] - middle});
    }
  }
  return ring;
}

/// Lines through a corner leave within this fraction of a side from it.
constexpr double kAtCorner = 1e-6;

/// From the first corner of `start` through the middle and the side `end`, if it goes there.
bool make_ray(std::uint32_t middle, const RingSide& start, const RingSide& end, double extent,
              Ray& ray) {
  const Vec3 side = end.to - end.from;
  const double l1 = length(start.from);
  const Vec3 on = (-1 / l1) * start.from;
  const Vec3 normal = cross(on, side);
  const double size = dot(normal, normal);
  const double l2 = dot(cross(end.from, side), normal) / size;
  double t = dot(cross(end.from, on), normal) / size;
  if (!(l2 > 0) || !(t >= -kAtCorner) || !(t < 1 - kAtCorner)) return false;
  if (t < kAtCorner) t = 0;
  if (end.a == start.a || (t > 0 && end.b == start.a)) return false;
  Stencil& s = ray.stencil;
  s.particles = {start.a, middle, end.a, t > 0 ? end.b : kNoIndex};
  s.weights = {1 / l1, -(1 / l1 + 1 / l2), (1 - t) / l2, t / l2};
  s.reading = plus_square({}, s.weights[0] / 2, start.from);
  s.reading = plus_square(s.reading, s.weights[2] / 2, end.from);
  s.reading = plus_square(s.reading, s.weights[3] / 2, end.to);
  s.rest = rest_of(s, s.weights[0] * start.from + s.weights[2] * end.from + s.weights[3] * end.to,
                   extent);
  ray.beside = t * (1 - t) * dot(side, side) / (l2 * (l1 + l2));
  ray.ends = pair_key(start.a, t < 0.5 ? end.a : end.b);
  return true;
}

class Adder {
 public:
  Adder(const std::vector<Face>& faces, const Edges& edges, double weld_distance,
        std::size_t particles, Stencils& into)
      : faces_(faces),
        edges_(edges),
        weld_distance_(weld_distance),
        extent_(extent(faces)),
        into_(into),
        lines_(particles) {
    for (const Stencil& s : into.stencils) {
      if (s.particles[3] != kNoIndex) continue;
      lines_[s.particles[1]].push_back(pair_key(s.particles[0], s.particles[2]));
    }
  }

  void add(std::uint32_t particle, CornersAround around) {
    if (!is_inner(around)) return;
    const auto ring = ring_of(faces_, around);
    if (!is_one_shape(ring)) return;
    const auto rays = best_rays(particle, ring);
    for (const Ray& ray : rays) add(ray, around, static_cast<double>(rays.size()));
  }

 private:
  bool is_inner(CornersAround around) const {
    return std::ranges::all_of(around, [&](const CornerOfFace& at) {
      const std::size_t before = faces_[at.face].previous(at.corner);
      return edges_.at(at.face, at.corner).is_inner() && edges_.at(at.face, before).is_inner();
    });
  }

  /// Whether faces have what they share in one place, seen from the particle.
  bool is_one_shape(const std::vector<RingSide>& ring) const {
    for (const RingSide& one : ring) {
      for (const RingSide& two : ring) {
        if (one.a == two.b && length(one.from - two.to) > weld_distance_) return false;
        if (one.a == two.a && length(one.from - two.from) > weld_distance_) return false;
      }
    }
    return true;
  }

  std::vector<Ray> best_rays(std::uint32_t particle, const std::vector<RingSide>& ring) const {
    std::vector<Ray> rays;
    Ray ray;
    for (const RingSide& start : ring) {
      for (const RingSide& end : ring) {
        if (!make_ray(particle, start, end, extent_, ray)) continue;
        const auto& lines = lines_[particle];
        if (std::ranges::find(lines, ray.ends) == lines.end()) rays.push_back(ray);
      }
    }
    std::ranges::stable_sort(rays, {}, &Ray::beside);
    std::vector<Ray> best;
    for (const Ray& candidate : rays) {
      const bool is_new = std::ranges::find(best, candidate.ends, &Ray::ends) == best.end();
      if (is_new && best.size() < kMostRays) best.push_back(candidate);
    }
    return best;
  }

  void add(const Ray& ray, CornersAround around, double rays) {
    const auto number = static_cast<std::uint32_t>(into_.stencils.size());
    into_.stencils.push_back(ray.stencil);
    for (const auto& [f, corner] : around) {
      const double share = corner_areas(faces_[f])[corner] / rays;
      into_.contributions.push_back({number, f, weight_among_others(ray.stencil, share)});
    }
  }

  const std::vector<Face>& faces_;
  const Edges& edges_;
  const double weld_distance_;
  const double extent_;  ///< m, of the mesh
  Stencils& into_;
  std::vector<std::vector<std::uint64_t>> lines_;  ///< ends of three points, by the middle
};

}  // namespace

void add_rays(const std::vector<Face>& faces, const Edges& edges, double weld_distance,
              const std::vector<std::uint32_t>& through, std::size_t particles,
              Stencils& stencils) {
  const Corners corners(faces, particles);
  Adder adder(faces, edges, weld_distance, particles, stencils);
  for (const std::uint32_t particle : through) adder.add(particle, corners.at(particle));
}

}  // namespace weft::mesh
