/// A ring.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/bodies/build_shape.h"
#include "engine/bodies/thin_shape.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;

constexpr double kMostSlender = 1e4;  // some 2000 links have to do for a thin one

/// All balls of a radius whose centres lie on a circle.
struct Ring {
  Vector centre{}, axis{};  // axis: a unit vector
  double major = 0, minor = 0;

  /// Two unit vectors across the axis, and across each other.
  std::array<Vector, 2> across() const {
    const Vector least = std::abs(axis.x) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    const Vector first = cross(axis, least);
    const Vector u = (1 / length(first)) * first;
    return {u, cross(axis, u)};
  }
};

class RingForm final : public reference::Form {
 public:
  explicit RingForm(const Ring& ring) : Form(ring.minor), ring_(ring), aside_(ring.across()[0]) {}
  /// From the nearest point of the circle; of the axis all of its points are.
  reference::Gap gap(Vector y) const override {
    const Vector from_centre = y - ring_.centre;
    const Vector out = from_centre - dot(from_centre, ring_.axis) * ring_.axis;
    const double l = length(out);
    const Vector toward = l > 0 ? (1 / l) * out : aside_;
    const Vector d = from_centre - ring_.major * toward;
    const double from_circle = length(d);
    return {from_circle - ring_.minor, from_circle > 0 ? (1 / from_circle) * d : toward};
  }

 private:
  Ring ring_;
  Vector aside_;
};

/// With w the distance from the axis and h the height: V = 2 pi^2 R r^2, the mean of w^2 is
/// R^2 + 3/4 r^2, and that of h^2 is r^2 / 4.
BodyMoments moments_of(const Ring& ring) {
  const double major = ring.major * ring.major, minor = ring.minor * ring.minor;
  const double volume = 2 * std::numbers::pi * std::numbers::pi * ring.major * minor;
  const auto [u, v] = ring.across();
  const double across = std::sqrt((major + 0.75 * minor) / 2), along = ring.minor / 2;
  // Six points with the same moments.
  BodyMoments moments;
  for (const Vector arm : {across * u, across * v, along * ring.axis}) {
    for (const double side : {-1.0, 1.0})
      moments.add(volume / 6, ring.centre + side * std::sqrt(3.0) * arm);
  }
  return moments;
}

/// A closed thread along the circle, whose links stay within a hundredth of the minor radius of it.
MeshShape thin_ring(const Ring& ring) {
  constexpr double kAside = 0.01;
  const double half = std::acos(1 - kAside * ring.minor / ring.major);  // of the angle of a link
  const auto count = static_cast<std::uint32_t>(std::ceil(std::numbers::pi / half));
  const auto [u, v] = ring.across();
  std::vector<Vector> places;
  std::vector<std::array<std::uint32_t, 2>> links;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    places.push_back(ring.centre + ring.major * (std::cos(angle) * u + std::sin(angle) * v));
    links.push_back({i, (i + 1) % count});
  }
  return thin_thread(places, std::vector<double>(count, ring.minor), links);
}

}  // namespace

BuiltShape build(const Torus& torus) {
  const Vector axis = to_internal(torus.axis);
  const double l = length(axis);
  if (!(l > 0) || !std::isfinite(l)) return refuse("axis", "has no direction", text(torus.axis));
  if (!(torus.minor < torus.major) || torus.minor < torus.major / kMostSlender) {
    return refuse("minor",
                  "must be from 1/10000 of major to less than that, " + number(torus.major),
                  number(torus.minor));
  }
  const Ring ring{to_internal(torus.centre), (1 / l) * axis, torus.major, torus.minor};
  const double width = 2 * torus.minor;
  ShapeParts parts;
  parts.form = std::make_unique<RingForm>(ring);
  parts.bounds.corners = {ring.centre};
  parts.bounds.radius = torus.major + torus.minor;
  parts.moments = moments_of(ring);
  parts.thin = std::make_unique<MeshShape>(thin_ring(ring));
  parts.widths = {.least = width, .most = width + 2 * torus.major};
  return std::make_shared<BodyShape>(std::move(parts));
}

}  // namespace weft
