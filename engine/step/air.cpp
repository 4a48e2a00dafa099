#include "engine/step/air.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/step/motion.h"
#include "engine/step/pressure.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

/// At a corner of a triangle, from twice its area vector and three times its velocity.
AirCoefficients air_coefficients_of(const AirStore& air, Vector area2, Vector v3) {
  const double flow = dot(area2, v3);
  AirCoefficients corner{.rate = air.density / 36 * air.drag * std::abs(flow)};
  if (air.lift == 0) return corner;
  const double size = std::sqrt(dot(area2, area2) * dot(v3, v3));
  if (size > 0) corner.spin = (air.density / 36 * air.lift * (flow / size)) * cross(v3, area2);
  return corner;
}

void find_air_coefficients(State& s, kernels::VectorsView x, kernels::VectorsView v,
                           std::size_t first, std::size_t last) {
  const AirStore& air = s.model->air;
  for (std::size_t i = first; i < last; ++i) {
    const auto [a, b, c] = air.triangles[i];
    const Vector from = x[a], area2 = cross(x[b] - from, x[c] - from);
    const Vector wind = s.wind_at((1. / 3) * (x[a] + x[b] + x[c]));
    s.air_coefficients[i] = air_coefficients_of(air, area2, v[a] + v[b] + v[c] - 3.0 * wind);
  }
}

/// rate y + spin x y = load
Vector solve(double rate, Vector spin, Vector load) {
  const Vector turn = (1 / rate) * spin;
  const double over = 1 / (rate * (1 + dot(turn, turn)));
  return over * (load + dot(turn, load) * turn - cross(turn, load));
}

AirCoefficients air_coefficients_at(const State& s, std::size_t slot) {
  AirCoefficients sum;
  for (const std::uint32_t i : s.model->air.at[slot]) {
    sum.rate += s.air_coefficients[i].rate;
    sum.spin = sum.spin + s.air_coefficients[i].spin;
  }
  return sum;
}

/// q = (1 - e^(-c h)) / (c h)
double share_of_decay(double rate, double h) {
  return rate > 0 ? -std::expm1(-rate * h) / (rate * h) : 1;
}

/// During h, of which forces act for the share q, with the rate of decay c.
Vector mean_acceleration_during(const State& s, std::size_t slot, Vector x, Vector v_here, double c,
                                double q, double h) {
  const Model& model = *s.model;
  const double w = model.inverse_mass[slot];
  const Vector lost = c * v_here;
  Vector load = s.gravity - lost;
  if (s.force.size() > 0) load = load + w * s.force[slot];
  if (!model.has_air()) return q * (load + lost);
  const AirCoefficients r = air_coefficients_at(s, slot);
  const Vector v = v_here - s.wind_at(x), spin = w * r.spin;
  load = load - (w * r.rate) * v - cross(spin, v);
  return q * (solve(1 + q * h * w * r.rate, (q * h) * spin, load) + lost);
}

}  // namespace

void find_velocity_forces(State& s, double c, double h, Team& team) {
  find_velocity_forces(s, s.position.view(), s.velocity.view(), c, h, team);
}

void find_velocity_forces(State& s, kernels::VectorsView x, kernels::VectorsView v, double c,
                          double h, Team& team) {
  const Model& model = *s.model;
  if (model.has_air()) {
    team.for_each_part(
        model.air.triangles.size(), kStretch,
        [&](std::size_t first, std::size_t last) { find_air_coefficients(s, x, v, first, last); });
  }
  find_ram(s, x, v, h);
  const double q = share_of_decay(c, h);
  team.for_each_part(model.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    for (std::size_t slot = first; slot < last; ++slot) {
      if (model.inverse_mass[slot] == 0) continue;
      const Vector a = mean_acceleration_during(s, slot, x[slot], v[slot], c, q, h);
      s.total_force.set(slot, model.mass[slot] * (a - s.gravity));
    }
  });
}

AirPace find_air_pace(State& s) {
  const Model& model = *s.model;
  if (!model.has_air()) return {};
  const AirStore& air = model.air;
  double area2 = 0, flow = 0, mass = 0;
  for (const auto& [a, b, c] : air.triangles) {
    const Vector from = s.position[a], way = s.position[b] - from, across = s.position[c] - from;
    const Vector v = (1. / 3) * (s.velocity[a] + s.velocity[b] + s.velocity[c]) - s.wind_at(from);
    const double size = length(cross(way, across));
    area2 += size;
    flow += size * length(v);
  }
  for (std::size_t slot = 0; slot < model.slots(); ++slot) {
    if (is_free_cloth(model, slot)) mass += model.mass[slot];
  }
  if (!(mass > 0) || !(area2 > 0)) return {};
  const double rate = 0.25 * air.density * (air.drag + air.lift) * flow / mass;
  const double cell = std::sqrt(area2 / static_cast<double>(air.triangles.size()));
  return {rate + rate_of_ram(s), std::sqrt(rate * (flow / area2) / cell)};
}

double parts_for_air(const AirPace& pace, double dt) {
  return std::max(1.0, std::ceil(pace.rate * dt / tuning::kAirShare));
}

void decay(State& s, double h) {
  const double left = std::exp(-s.model->damping.motion * h);
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] > 0) s.velocity.set(slot, left * s.velocity[slot]);
  }
}

}  // namespace weft
