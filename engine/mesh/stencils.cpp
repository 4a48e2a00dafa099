#include "engine/mesh/stencils.h"

namespace weft::mesh {

Vec3 weighted_sum(const std::array<double, 4>& weights, const std::array<Vec3, 4>& places) {
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i) sum = sum + weights[i] * (places[i] - places[0]);
  return sum;
}

Stencil hinge(Point a, Point b, Point far_a, Point far_b, Vec3 a_of_other, Vec3 b_of_other,
              bool is_seam) {
  struct Side {
    double along = 0, height = 0;  ///< m, of the far corner from a, and from the edge
    Vec3 across;
  };
  const auto side = [](Vec3 from, Vec3 to, Vec3 corner) {
    const Vec3 edge = unit(to - from);
    const Vec3 offset = corner - from;
    const double along = dot(offset, edge);
    const Vec3 across = offset - along * edge;
    return Side{along, length(across), unit(across)};
  };
  const Side one = side(a.place, b.place, far_a.place);
  const Side two = side(a_of_other, b_of_other, far_b.place);
  const double size = length(b.place - a.place);
  const Vec3 edge = unit(b.place - a.place);
  Vec3 across = is_seam ? one.across : unit(one.across - two.across);
  if (dot(across, across) == 0) across = one.across;

  Stencil stencil;
  stencil.particles = {a.particle, b.particle, far_a.particle, far_b.particle};
  const double w2 = 1 / one.height, w3 = 1 / two.height;
  const double w1 = -(one.along * w2 + two.along * w3) / size;
  stencil.weights = {-(w1 + w2 + w3), w1, w2, w3};
  const Vec3 flat[] = {Vec3{}, size * edge, one.along * edge + one.height * across,
                       two.along * edge - two.height * across};
  for (std::size_t i = 0; i < 4; ++i) {
    stencil.reading = plus_square(stencil.reading, stencil.weights[i] / 2, flat[i]);
  }
  return stencil;
}

Stencil without_end(const Stencil& hinge, std::uint32_t kept) {
  constexpr double kRounding = 1e-6;
  const std::size_t end = hinge.particles[0] == kept ? 0 : 1, other = 1 - end;
  const auto& w = hinge.weights;
  if (std::abs(w[other]) > kRounding * (w[2] + w[3])) return hinge;
  Stencil line = hinge;
  line.particles = {hinge.particles[2], kept, hinge.particles[3], kNoIndex};
  line.weights = {w[2], -(w[2] + w[3]), w[3], 0};
  return line;
}

double fold_of(const Stencil& hinge, const std::array<Vec3, 4>& places, double extent) {
  const Vec3 sum = weighted_sum(hinge.weights, places);
  if (rest_of(hinge, sum, extent) == 0) return 0;
  const Vec3 edge = places[1] - places[0];
  const Vec3 across =
      hinge.weights[3] * (places[3] - places[0]) - hinge.weights[2] * (places[2] - places[0]);
  const Vec3 normal = cross(unit(edge), across);
  return dot(sum, normal) < 0 ? -length(sum) : length(sum);
}

double rest_of(const Stencil& stencil, Vec3 sum, double extent) {
  constexpr double kRounding = 0x1p-23;
  double size = 0;
  for (const double weight : stencil.weights) size += std::abs(weight);
  const double distance = length(sum);
  return distance > kRounding * extent * size ? distance : 0;
}

double weight_in_grid(const Stencil& stencil, double area) {
  return area / sum_of_squares(stencil.reading);
}

double weight_among_others(const Stencil& stencil, double area) {
  const double sum = trace(stencil.reading);
  return 8 * area / (2 * sum_of_squares(stencil.reading) + sum * sum);
}

}  // namespace weft::mesh
