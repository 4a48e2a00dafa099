#include "engine/contact/impact_zones.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/contact/mover.h"

namespace weft {

using kernels::Vector;

namespace {

/// The solution of I w = l, with I the inertia of points around their centre.
class Inertia {
 public:
  void add(double mass, Vector r) {
    const double square = dot(r, r);
    xx_ += mass * (square - r.x * r.x);
    yy_ += mass * (square - r.y * r.y);
    zz_ += mass * (square - r.z * r.z);
    xy_ -= mass * r.x * r.y;
    xz_ -= mass * r.x * r.z;
    yz_ -= mass * r.y * r.z;
  }
  /// Particles on one line do not turn around it.
  Vector solve(Vector l) const {
    constexpr double kLeast = 1e-9;
    const double spare = kLeast * (xx_ + yy_ + zz_);
    if (!(spare > 0)) return {};
    const double a = xx_ + spare, b = yy_ + spare, c = zz_ + spare;
    const Vector x{b * c - yz_ * yz_, xz_ * yz_ - xy_ * c, xy_ * yz_ - xz_ * b},
        y{x.y, a * c - xz_ * xz_, xy_ * xz_ - a * yz_}, z{x.z, y.z, a * b - xy_ * xy_};
    const double determinant = a * x.x + xy_ * x.y + xz_ * x.z;
    return (1 / determinant) * Vector{dot(x, l), dot(y, l), dot(z, l)};
  }

 private:
  double xx_ = 0, yy_ = 0, zz_ = 0, xy_ = 0, xz_ = 0, yz_ = 0;
};

/// r turned by an angle (rad) around the axis of that direction.
Vector turned(Vector r, Vector angle) {
  const double a = length(angle);
  if (a == 0) return r;
  const Vector n = (1 / a) * angle;
  return std::cos(a) * r + std::sin(a) * cross(n, r) + ((1 - std::cos(a)) * dot(n, r)) * n;
}

}  // namespace

/// From where points were: a turn around the centre, and a way.
struct ImpactZones::Rigid {
  Vector centre{}, way{}, angle{};  // m, m, rad
  Vector velocity{}, spin{};
  std::uint32_t body = kNoIndex;  // with which it goes
  bool has_place = false;         // and whose place it keeps
  reference::Placement begins{}, ends{};

  Vector place(Vector start) const {
    if (has_place) return ends.placed(begins.from_place(start));
    return centre + way + turned(start - centre, angle);
  }
};

void ImpactZones::begin() {
  for (const std::uint32_t point : points_) {
    parent_[point] = point;
    is_in_[point] = false;
  }
  points_.clear();
}

std::size_t ImpactZones::bytes() const {
  return bytes_of(parent_) + is_in_.capacity() / 8 + bytes_of(points_);
}

void ImpactZones::add(std::uint32_t point) {
  if (parent_.size() <= point) {
    const auto before = parent_.size();
    parent_.resize(point + 1);
    is_in_.resize(point + 1);
    std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(before), parent_.end(),
              static_cast<std::uint32_t>(before));
  }
  if (is_in_[point]) return;
  is_in_[point] = true;
  points_.push_back(point);
}

std::uint32_t ImpactZones::root_of(std::uint32_t point) {
  while (parent_[point] != point) point = parent_[point] = parent_[parent_[point]];
  return point;
}

void ImpactZones::unite(std::uint32_t a, std::uint32_t b) {
  a = root_of(a);
  b = root_of(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

void ImpactZones::join(const std::array<std::uint32_t, 4>& points) {
  for (const std::uint32_t point : points) add(point);
  for (std::size_t k = 1; k < 4; ++k) unite(points[0], points[k]);
}

void ImpactZones::grow(const ContactScene& scene) {
  const std::size_t count = points_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t point = points_[i];
    if (!scene.points.is_of_cloth(point)) continue;
    for (const std::uint32_t other : scene.points.cloth().neighbours[point]) {
      add(other);
      unite(point, other);
    }
  }
}

/// Where one is: a body that keeps its shape, or else the mean way of what is fixed.
bool ImpactZones::follows(const ContactPoints& points, std::size_t first, std::size_t last,
                          Rigid& motion, double time) const {
  Vector sum{};
  double count = 0;
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t point = points_[i];
    if (points.inverse_mass(point) > 0) continue;
    sum = sum + (points.end(point) - points.start(point));
    ++count;
    if (points.is_of_cloth(point)) continue;
    const ContactSurface& surface = points.surface_of(point);
    motion.body = surface.body;
    motion.begins = surface.begins;
    motion.ends = surface.ends;
    motion.has_place = surface.is_rigid;
    if (motion.has_place) return true;
  }
  if (count == 0) return false;
  motion.way = (1 / count) * sum;
  motion.velocity = (1 / time) * motion.way;
  return true;
}

ImpactZones::Rigid ImpactZones::motion_of(const ContactScene& scene, std::size_t first,
                                          std::size_t last, double time) const {
  Rigid motion;
  if (follows(scene.points, first, last, motion, time)) return motion;
  const ContactPoints& points = scene.points;
  double mass = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double m = scene.model.mass[points_[i]];
    mass += m;
    motion.centre = motion.centre + m * points.start(points_[i]);
    motion.way = motion.way + m * (points.end(points_[i]) - points.start(points_[i]));
    motion.velocity = motion.velocity + m * scene.particles.read(points_[i]).v;
  }
  for (Vector* v : {&motion.centre, &motion.way, &motion.velocity}) *v = (1 / mass) * *v;
  Inertia inertia;
  Vector turns{}, spins{};
  for (std::size_t i = first; i < last; ++i) {
    const double m = scene.model.mass[points_[i]];
    const Vector r = points.start(points_[i]) - motion.centre;
    inertia.add(m, r);
    turns = turns + m * cross(r, points.end(points_[i]) - points.start(points_[i]));
    spins = spins + m * cross(r, scene.particles.read(points_[i]).v);
  }
  motion.angle = inertia.solve(turns);
  motion.spin = inertia.solve(spins);
  return motion;
}

void ImpactZones::move(const ContactScene& scene, double time) {
  for (const std::uint32_t point : points_) parent_[point] = root_of(point);
  std::ranges::sort(points_, {}, [&](std::uint32_t point) {
    return std::uint64_t{parent_[point]} << 32 | point;
  });
  for (std::size_t first = 0, last = 0; first < points_.size(); first = last) {
    while (last < points_.size() && parent_[points_[last]] == parent_[points_[first]]) ++last;
    const Rigid motion = motion_of(scene, first, last, time);
    const Mover mover(scene, motion.body);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t point = points_[i];
      if (!(scene.points.inverse_mass(point) > 0)) continue;
      const Vector start = scene.points.start(point), end = motion.place(start);
      const Vector velocity = motion.has_place
                                  ? (1 / time) * (end - start)
                                  : motion.velocity + cross(motion.spin, start - motion.centre);
      const ContactParticle particle = scene.particles.read(point);
      mover.move_in_zone(point, end - particle.x, velocity - particle.v, velocity);
    }
  }
}

}  // namespace weft
