#include "engine/step/pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/model/pressures.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/step/motion.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;
using kernels::VectorsView;

/// m^2, twice its area times its normal.
template <class Places>
Vector twice_area(const Places& x, const SurfaceTriangle& t) {
  const Vector from = x[t[0]];
  return cross(x[t[1]] - from, x[t[2]] - from);
}

/// work(pressure, corners) for each triangle that feels one of `given`, where is_of_gas, or else.
template <class Work>
void for_each_given(const State& s, bool is_of_gas, Work&& work) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    if (s.pressures[i].gas != is_of_gas) continue;
    const double pressure = s.pressed.given[i];
    for_each_triangle(s.pressures[i], s.model->surface,
                      [&](const SurfaceTriangle& t) { work(pressure, t); });
  }
}
template <class Work>
void for_each_in_ram(const State& s, Work&& work) {
  if (!s.model->has_ram()) return;
  const AirStore& air = s.model->air;
  for (std::size_t i = 0; i < air.triangles.size(); ++i)
    work(s.pressed.ram[air.piece[i]], air.triangles[i]);
}

double volume_of(const Model& model, const Pressure& part, VectorsView x) {
  double volume = 0;
  Vector origin{0, 0, 0};
  bool is_first = true;
  for_each_triangle(part, model.surface, [&](const SurfaceTriangle& t) {
    if (std::exchange(is_first, false)) origin = x[t[0]];
    const Vector a = x[t[0]] - origin, b = x[t[1]] - origin, c = x[t[2]] - origin;
    volume += dot(a, cross(b, c)) / 6;
  });
  return volume;
}

double volume_that_counts(const Pressure& part, double volume) {
  return std::max(volume, tuning::kLeastOfGas * part.volume);
}
/// Pa, beyond the air around.
double pressure_of_gas(const Pressure& part, double volume) {
  return (part.ambient + part.pressure) * (part.volume / volume_that_counts(part, volume)) -
         part.ambient;
}
/// J, from one volume to another.
double work_of_gas(const Pressure& part, double from, double to) {
  const double least = tuning::kLeastOfGas * part.volume;
  const double whole = (part.ambient + part.pressure) * part.volume;
  const double a = volume_that_counts(part, from), b = volume_that_counts(part, to);
  const double pressed = (std::min(to, least) - std::min(from, least)) * (whole / least);
  return whole * std::log(b / a) + pressed - part.ambient * (to - from);
}

/// The areas of the triangles of a gas, per particle.
void find_areas(State& s, const Pressure& part, VectorsView x) {
  for_each_triangle(part, s.model->surface, [&](const SurfaceTriangle& t) {
    for (const std::uint32_t slot : t) s.pressed.area.set(slot, {0, 0, 0});
  });
  for_each_triangle(part, s.model->surface, [&](const SurfaceTriangle& t) {
    const Vector share = (1. / 6) * twice_area(x, t);
    for (const std::uint32_t slot : t) s.pressed.area.view().add(slot, share);
  });
}

/// sum a . a / m, each particle once: a corner has its share of the sum over its triangles.
double mobility(const State& s, const Pressure& part, VectorsView x) {
  double sum = 0;
  for_each_triangle(part, s.model->surface, [&](const SurfaceTriangle& t) {
    const Vector share = (1. / 6) * twice_area(x, t);
    for (const std::uint32_t slot : t)
      sum += s.model->inverse_mass[slot] * dot(s.pressed.area[slot], share);
  });
  return sum;
}

/// Pa, p of pressure.h, from q.
double implicit_pressure(const Pressure& part, double q, double volume, double c) {
  const double whole = (part.ambient + part.pressure) * part.volume, w = volume - c * q;
  const double b = w + part.ambient * c, difference = w - part.ambient * c;
  const double root = std::sqrt(difference * difference + 4 * c * whole);
  return b > 0 ? 2 * (whole - part.ambient * w) / (b + root) : (root - b) / (2 * c);
}

void give_way(State& s, std::size_t i, VectorsView x) {
  const Pressure& part = s.pressures[i];
  SmallSteps& solver = *s.small_steps;
  find_areas(s, part, x);
  const double give = solver.give_of_force(), before = s.pressed.given[i];
  s.pressed.given[i] =
      implicit_pressure(part, before, volume_of(*s.model, part, x), give * mobility(s, part, x));
  const double more = s.pressed.given[i] - before;
  for_each_triangle(part, s.model->surface, [&](const SurfaceTriangle& t) {
    for (const std::uint32_t slot : t) {
      const Vector force = more * s.pressed.area[slot];
      s.pressed.area.set(slot, {0, 0, 0});  // once for each particle
      if (s.model->inverse_mass[slot] == 0 || force == Vector{0, 0, 0}) continue;
      s.total_force.view().add(slot, force);
      solver.shift(slot, give * s.model->inverse_mass[slot] * force);
    }
  });
}

/// N/m, the mean of what cloth has against stretch; infinite: it is rigid.
double stiffness_of(const Model& model) {
  const MembraneStore& membrane = model.membrane;
  double sum = 0;
  if (membrane.size() > 0) {
    for (const auto& element : membrane.element)
      sum += 0.5 * (element.stiffness[0] + element.stiffness[1]);
    return sum / static_cast<double>(membrane.size());
  }
  for (const double compliance : model.constraints.compliance) sum += compliance;
  const auto count = static_cast<double>(model.constraints.size());
  return sum > 0 ? count / sum : std::numeric_limits<double>::infinity();
}

/// m/s, of the wind that a piece catches, against the normal of its mouth.
double flow_into(const Caught& piece) {
  const double mouth = length(piece.mouth);
  return mouth > 0 ? dot(piece.moved, piece.mouth) / (piece.area * mouth) : 0;
}

void catch_wind(State& s, VectorsView x, VectorsView v) {
  const AirStore& air = s.model->air;
  std::ranges::fill(s.pressed.caught, Caught{});
  for (std::size_t i = 0; i < air.piece.size(); ++i) {
    const SurfaceTriangle& t = air.triangles[i];
    Caught& piece = s.pressed.caught[air.piece[i]];
    const Vector area = 0.5 * twice_area(x, t);
    const double size = length(area);
    const Vector wind = s.wind_at((1. / 3) * (x[t[0]] + x[t[1]] + x[t[2]]));
    piece.mouth = piece.mouth + area;
    piece.area += size;
    piece.moved = piece.moved + size * ((1. / 3) * (v[t[0]] + v[t[1]] + v[t[2]]) - wind);
    for (const std::uint32_t slot : t)
      piece.mass += s.model->mass[slot] / static_cast<double>(air.at[slot].size());
  }
}

}  // namespace

void find_ram(State& s, VectorsView x, VectorsView v, double h) {
  if (!s.model->has_ram()) return;
  const AirStore& air = s.model->air;
  catch_wind(s, x, v);
  for (std::size_t k = 0; k < s.pressed.ram.size(); ++k) {
    const Caught& piece = s.pressed.caught[k];
    const double u = air.is_open[k] ? flow_into(piece) : 0;
    const double most = piece.mass / (h * length(piece.mouth));
    s.pressed.ram[k] = u == 0 ? 0 : -std::min(0.5 * air.density * air.ram * std::abs(u), most) * u;
  }
}

double rate_of_ram(State& s) {
  if (!s.model->has_ram()) return 0;
  const AirStore& air = s.model->air;
  catch_wind(s, s.position.view(), s.velocity.view());
  double rate = 0;
  for (std::size_t k = 0; k < s.pressed.caught.size(); ++k) {
    const Caught& piece = s.pressed.caught[k];
    if (!air.is_open[k] || !(piece.mass > 0)) continue;
    const double taken = 0.5 * air.density * air.ram * std::abs(flow_into(piece));
    rate = std::max(rate, taken * length(piece.mouth) / piece.mass);
  }
  return rate;
}

void begin_pressing(State& s) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) s.pressed.given[i] = s.gas[i];
}

std::vector<double> gas_going_on(const State& s, std::span<const Pressure> next) {
  std::vector<double> gas(next.size());
  for (std::size_t i = 0; i < std::min(next.size(), s.pressures.size()); ++i) {
    const Pressure& before = s.pressures[i];
    if (before.gas && next[i].gas && before.triangles == next[i].triangles) gas[i] = s.gas[i];
  }
  return gas;
}

double length_for_pressure(const State& s) {
  double load = 0, area = 0, mass = 0;  // N, m^2, kg
  const auto add = [&](double pressure, const SurfaceTriangle& t) {
    const double size = 0.5 * length(twice_area(s.position, t));
    load += std::abs(pressure) * size;
    area += size;
  };
  for (const Pressure& part : s.pressures) {
    for_each_triangle(part, s.model->surface,
                      [&](const SurfaceTriangle& t) { add(part.pressure, t); });
  }
  for_each_in_ram(s, add);
  const double cell = s.model->small_steps().load.mean_length;
  if (!(load > 0 && cell > 0)) return std::numeric_limits<double>::infinity();
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (is_free_cloth(*s.model, slot)) mass += s.model->mass[slot];
  }
  constexpr double kBall = 4 * std::numbers::pi;
  const double tension = 0.5 * load / area * std::sqrt(area / kBall);
  const double strain = s.settings.tolerance + tension / stiffness_of(*s.model);
  return cell * std::sqrt(0.5 * strain * mass / (area * tension));
}

void press(State& s, VectorsView x) {
  std::swap(s.pressed.held, s.pressed.before);
  std::swap(s.pressed.volume, s.pressed.volume_before);
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    const Pressure& part = s.pressures[i];
    if (part.gas)
      s.pressed.volume[i] = volume_of(*s.model, part, x);
    else
      s.pressed.given[i] = part.pressure;
  }
  const auto add_to = [x](VectorsView sum) {
    return [x, sum](double pressure, const SurfaceTriangle& t) {
      const Vector share = (pressure / 6) * twice_area(x, t);
      for (const std::uint32_t slot : t) sum.add(slot, share);
    };
  };
  const VectorsView held = s.pressed.held.view(), total = s.total_force.view();
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) held.set(slot, {0, 0, 0});
  for_each_given(s, false, add_to(held));
  for_each_in_ram(s, add_to(held));
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot)
    total.set(slot, s.pressed.beside[slot] + s.pressed.held[slot]);
  for_each_given(s, true, add_to(total));
}

void let_gas_give_way(State& s, VectorsView x) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    if (s.pressures[i].gas) give_way(s, i, x);
  }
}

double work_of_pressure(const State& s) {
  double work = 0;
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    if (s.pressures[i].gas)
      work += work_of_gas(s.pressures[i], s.pressed.volume_before[i], s.pressed.volume[i]);
  }
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    const Vector mean = 0.5 * (s.pressed.before[slot] + s.pressed.held[slot]);
    work += dot(mean, s.solved[slot] - s.air_from[slot]);
  }
  return work;
}

Vector sum_of_pressure(const State& s) {
  Vector sum{0, 0, 0};
  const auto add = [&](double pressure, const SurfaceTriangle& t) {
    sum = sum + (0.5 * pressure) * twice_area(s.position, t);
  };
  for_each_given(s, false, add);
  for_each_given(s, true, add);
  for_each_in_ram(s, add);
  return sum;
}

PressureNow pressure_now(const Model& model, const Pressure& part, VectorsView x) {
  const bool closes = !find_border(triangles_of(part, model.surface));
  const double volume = closes ? volume_of(model, part, x) : 0;
  return {part.gas ? pressure_of_gas(part, volume) : part.pressure, volume};
}

}  // namespace weft
