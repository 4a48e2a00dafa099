#include "engine/contact/untangling.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/tuning.h"
#include "kernels/reference/contacts.h"

namespace weft {

using kernels::Vector;

namespace {

Vector unit(Vector v) { return kernels::direction(v, length(v)); }

/// Where a piercing is, when the interval begins.
struct PiercingSeen {
  Vector place{};                        // on the edge
  Vector along{};                        // the edge, a unit vector
  std::array<Vector, 3> corners{};       // of the triangle
  Vector normal{};                       // of the triangle, a unit vector
  std::array<Vector, 2> beside{};        // from the edge into its faces, across it, unit vectors
  std::array<Vector, 2> face_normals{};  // unit vectors, as if the faces were one that lies flat
  std::size_t faces = 0;
};

PiercingSeen seen_at(const ContactPoints& points, const Piercing& piercing) {
  const auto at = [&](std::size_t k) { return points.start(piercing.points[k]); };
  PiercingSeen seen;
  seen.place = piercing.weight[0] * at(0) + piercing.weight[1] * at(1);
  seen.along = unit(at(1) - at(0));
  seen.corners = {at(2), at(3), at(4)};
  seen.normal = unit(cross(at(3) - at(2), at(4) - at(2)));
  for (const std::uint32_t third : points.cloth().opposite[piercing.edge]) {
    if (third == kNoIndex) continue;
    const Vector to = points.start(third) - at(0);
    const Vector beside = unit(to - dot(to, seen.along) * seen.along);
    const double turn = seen.faces == 0 ? 1 : -1;
    seen.beside[seen.faces] = beside;
    seen.face_normals[seen.faces++] = turn * cross(seen.along, beside);
  }
  return seen;
}

/// Where both ends are on one side of the triangle: farther to it.
Vector farther(const Piercing& piercing, const PiercingSeen& seen) {
  return (piercing.side[0] + piercing.side[1] < 0 ? -1.0 : 1.0) * seen.normal;
}

/// The way by which the wrong part comes through; 0 where it is not there.
Vector out(const ContactPoints& points, const Piercing& piercing, const PiercingSeen& seen,
           const WrongPart& wrong) {
  const auto is_wrong = [&](std::size_t k) { return wrong.has(points, piercing.points[k]); };
  if (is_wrong(0) != is_wrong(1)) {
    const double side_of_right = piercing.side[is_wrong(0) ? 1 : 0];
    return (side_of_right < 0 ? -1.0 : 1.0) * seen.normal;
  }
  if (is_wrong(2) == is_wrong(3) && is_wrong(3) == is_wrong(4)) return {};
  const Vector n = unit(seen.face_normals[0] + seen.face_normals[1]);
  double right = 0;  // m, of what is on the right side, along n
  for (std::size_t k = 0; k < 3; ++k)
    right += (is_wrong(2 + k) ? -1 : 1) * dot(n, seen.corners[k] - seen.place);
  return (right < 0 ? 1.0 : -1.0) * n;
}

/// By which the contour becomes shorter, if the edge moves so beside the triangle: the sum of the
/// directions in which it leads on into the faces of the edge, as far as the edge takes it along.
Vector shorter(const PiercingSeen& seen) {
  constexpr double kLeastSine = 0.1;  // an edge that lies flatter takes its piercing far along
  const double rise = dot(seen.along, seen.normal);
  const double most = std::copysign(std::max(std::abs(rise), kLeastSine), rise);
  Vector sum{};
  for (std::size_t k = 0; k < seen.faces; ++k) {
    const Vector line = cross(seen.face_normals[k], seen.normal);
    if (line == Vector{}) continue;
    const Vector on = (dot(line, seen.beside[k]) < 0 ? -1.0 : 1.0) * unit(line);
    sum = sum + on - (2 * dot(seen.along, on) / most) * seen.normal;
  }
  return sum;
}

}  // namespace

void Untangling::add(const ContactPoints& points, const Piercing& piercing) {
  const PiercingSeen seen = seen_at(points, piercing);
  Vector to{};
  if (!piercing.is_through())
    to = farther(piercing, seen);
  else if (wrong_.any())
    to = out(points, piercing, seen, wrong_);
  if (to == Vector{}) to = shorter(seen);
  const double l = length(to);
  if (!(l > 0)) return;
  pulls_.push_back({piercing.points, piercing.weight, (1 / l) * to, std::min(1.0, l)});
}

void Untangling::begin_interval(const ContactPoints& points,
                                const std::vector<std::uint64_t>& crossing) {
  leave();
  if (crossing.empty()) return;
  contours_.find(points, crossing);
  const std::span<const Piercing> all = contours_.piercings();
  for (std::size_t i = 0, next = 0; i < all.size(); i = next) {
    while (next < all.size() && all[next].contour == all[i].contour) ++next;
    const auto contour = all.subspan(i, next - i);
    wrong_.find(points, contour);
    for (const Piercing& piercing : contour) add(points, piercing);
  }
}

/// One after the other: what an earlier one has pulled apart counts.
void Untangling::pull(const ContactScene& scene) {
  if (pulls_.empty()) return;
  const double h = scene.clock.dt_substep(), bh = h / scene.particles.momentum_share();
  ways_.resize(scene.points.slots());
  for (Pull& pull : pulls_) {
    double weight = 0, largest = 0;
    for (std::size_t k = 0; k < pull.points.size(); ++k) {
      const double inverse = scene.points.inverse_mass(pull.points[k]);
      weight += pull.weight[k] * pull.weight[k] * inverse;
      largest = std::max(largest, inverse);
    }
    pull.force = 0;
    if (!(weight > 0)) continue;
    const double speed = pull.share * tuning::kUntanglingSpeed,
                 missing = std::clamp(speed - way(scene.particles, pull) / h, -speed, speed);
    pull.force =
        missing / (tuning::kUntanglingTime + h) / std::max(weight, reference::kLeastGive * largest);
    for (std::size_t k = 0; k < pull.points.size(); ++k) {
      Vector& by = ways_[pull.points[k]];
      const double inverse = scene.points.inverse_mass(pull.points[k]);
      by = by + (bh * bh * pull.force * pull.weight[k] * inverse) * pull.along;
    }
  }
  for (const Pull& pull : pulls_) {
    for (const std::uint32_t point : pull.points) {
      const Vector by = std::exchange(ways_[point], Vector{});
      if (!(by == Vector{})) scene.particles.move_to(point, scene.particles.position(point) + by);
    }
  }
  is_begun_ = true;
}

/// m, along the pull, since the substep began.
double Untangling::way(const ContactParticles& particles, const Pull& pull) const {
  double sum = 0;
  for (std::size_t k = 0; k < pull.points.size(); ++k) {
    const std::uint32_t point = pull.points[k];
    const Vector moved = particles.position(point) - particles.start(point);
    sum += pull.weight[k] * dot(pull.along, moved + ways_[point]);
  }
  return sum;
}

void Untangling::end_substep(const ContactParticles& particles) {
  if (!std::exchange(is_begun_, false)) return;
  for (const Pull& pull : pulls_) work_ += pull.force * way(particles, pull);
}

std::size_t Untangling::bytes() const {
  return contours_.bytes() + wrong_.bytes() + bytes_of(pulls_) + bytes_of(ways_);
}

}  // namespace weft
