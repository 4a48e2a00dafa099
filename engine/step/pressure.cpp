#include "engine/step/pressure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/model/pressures.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/step/air.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;
using kernels::VectorsView;

/// m^2, twice its area times its normal.
Vector twice_area(VectorsView x, const Corners& t) {
  const Vector from = x[t[0]];
  return cross(x[t[1]] - from, x[t[2]] - from);
}

/// work(pressure, corners) for each triangle that feels one. with_gas: of gas, too.
template <class Work>
void for_each_pressed(const State& s, bool with_gas, Work&& work) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    const double pressure = s.pressed.given[i];
    if (s.pressures[i].gas && !with_gas) continue;
    for_each_triangle(s.pressures[i], s.model->surface,
                      [&](const Corners& t) { work(pressure, t); });
  }
  if (!s.model->has_ram()) return;
  const AirStore& air = s.model->air;
  for (std::size_t i = 0; i < air.triangles.size(); ++i)
    work(s.pressed.ram[air.piece[i]], air.triangles[i]);
}

double volume_of(const Model& model, const Pressure& part, VectorsView x) {
  double volume = 0;
  Vector origin{0, 0, 0};
  bool is_first = true;
  for_each_triangle(part, model.surface, [&](const Corners& t) {
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

/// m^3, that a triangle sweeps on a straight way, along its normal: exact.
double swept(VectorsView from, VectorsView to, const Corners& t) {
  const Vector a = from[t[0]], b = from[t[1]], c = from[t[2]];
  const Vector da = to[t[0]] - a, db = to[t[1]] - b, dc = to[t[2]] - c;
  const Vector u = b - a, v = c - a, du = db - da, dv = dc - da;
  const Vector mean = cross(u, v) + 0.5 * (cross(du, v) + cross(u, dv)) + (1. / 3) * cross(du, dv);
  return dot(mean, da + db + dc) / 6;
}

/// The areas of the triangles of a gas, per particle.
void find_areas(State& s, const Pressure& part, VectorsView x) {
  for_each_triangle(part, s.model->surface, [&](const Corners& t) {
    for (const std::uint32_t slot : t) s.pressed.area.set(slot, {0, 0, 0});
  });
  for_each_triangle(part, s.model->surface, [&](const Corners& t) {
    const Vector share = (1. / 6) * twice_area(x, t);
    for (const std::uint32_t slot : t) s.pressed.area.view().add(slot, share);
  });
}

/// sum a . a / m, each particle once: a corner has its share of the sum over its triangles.
double mobility(const State& s, const Pressure& part, VectorsView x) {
  double sum = 0;
  for_each_triangle(part, s.model->surface, [&](const Corners& t) {
    const Vector share = (1. / 6) * twice_area(x, t);
    for (const std::uint32_t slot : t)
      sum += s.model->inverse_mass[slot] * dot(s.pressed.area[slot], share);
  });
  return sum;
}

void give_way(State& s, std::size_t i, VectorsView x) {
  const Pressure& part = s.pressures[i];
  SmallSteps& solver = *s.small_steps;
  const double volume = volume_of(*s.model, part, x);
  find_areas(s, part, x);
  const double give = solver.give_of_force();
  const double steep =
      (pressure_of_gas(part, volume) + part.ambient) / volume_that_counts(part, volume);
  const double more = (pressure_of_gas(part, volume) - s.pressed.given[i]) /
                      (1 + steep * give * mobility(s, part, x));
  s.pressed.given[i] += more;
  for_each_triangle(part, s.model->surface, [&](const Corners& t) {
    for (const std::uint32_t slot : t) {
      const Vector force = more * s.pressed.area[slot];
      s.pressed.area.set(slot, {0, 0, 0});  // once for each particle
      if (s.model->inverse_mass[slot] == 0 || force == Vector{0, 0, 0}) continue;
      s.total_force.view().add(slot, force);
      solver.shift(slot, give * s.model->inverse_mass[slot] * force);
    }
  });
}

}  // namespace

bool presses(const State& s) { return !s.pressures.empty() || s.model->has_ram(); }

void make_room_for_pressure(State& s) {
  const Model& model = *s.model;
  const bool has_pressure = presses(s);
  const auto gives_room = [&](kernels::Vectors& v, bool needed) {
    if ((v.size() > 0) != needed) v.resize(needed ? model.slots() : 0);
  };
  gives_room(s.total_force, is_resisted(model) || has_pressure);
  gives_room(s.air_from, model.has_air() || has_pressure);
  gives_room(s.air_impulse, model.has_air() || has_pressure);
  gives_room(s.pressed.beside, has_pressure);
  gives_room(s.pressed.area, std::ranges::any_of(s.pressures, &Pressure::gas));
  s.pressed.given.resize(s.pressures.size());
  const std::size_t pieces = model.has_ram() ? model.air.is_open.size() : 0;
  s.pressed.ram.resize(pieces);
  s.pressed.caught.resize(pieces);
}

void find_ram(State& s, VectorsView x, VectorsView v, double h) {
  if (!s.model->has_ram()) return;
  const AirStore& air = s.model->air;
  std::ranges::fill(s.pressed.caught, Caught{});
  for (std::size_t i = 0; i < air.piece.size(); ++i) {
    const Corners& t = air.triangles[i];
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
  for (std::size_t k = 0; k < s.pressed.ram.size(); ++k) {
    const Caught& piece = s.pressed.caught[k];
    const double mouth = length(piece.mouth);
    s.pressed.ram[k] = 0;
    if (!air.is_open[k] || !(mouth > 0)) continue;
    const double u = dot(piece.moved, piece.mouth) / (piece.area * mouth);
    const double most = piece.mass / (h * mouth);
    s.pressed.ram[k] = -std::min(0.5 * air.density * air.ram * std::abs(u), most) * u;
  }
}

void press(State& s, VectorsView x) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    const Pressure& part = s.pressures[i];
    s.pressed.given[i] =
        part.gas ? pressure_of_gas(part, volume_of(*s.model, part, x)) : part.pressure;
  }
  s.total_force = s.pressed.beside;
  for_each_pressed(s, true, [&](double pressure, const Corners& t) {
    const Vector share = (pressure / 6) * twice_area(x, t);
    for (const std::uint32_t slot : t) s.total_force.view().add(slot, share);
  });
}

void let_gas_give_way(State& s, VectorsView x) {
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    if (s.pressures[i].gas) give_way(s, i, x);
  }
}

double work_of_pressure(const State& s, VectorsView from, VectorsView to) {
  double work = 0;
  for (std::size_t i = 0; i < s.pressures.size(); ++i) {
    const Pressure& part = s.pressures[i];
    if (!part.gas) continue;
    work += work_of_gas(part, volume_of(*s.model, part, from), volume_of(*s.model, part, to));
  }
  for_each_pressed(
      s, false, [&](double pressure, const Corners& t) { work += pressure * swept(from, to, t); });
  return work;
}

Vector sum_of_pressure(const State& s, VectorsView x) {
  Vector sum{0, 0, 0};
  for_each_pressed(s, true, [&](double pressure, const Corners& t) {
    sum = sum + (0.5 * pressure) * twice_area(x, t);
  });
  return sum;
}

PressureNow pressure_now(const Model& model, const Pressure& part, VectorsView x) {
  const bool closes = !find_border(triangles_of(part, model.surface));
  const double volume = closes ? volume_of(model, part, x) : 0;
  return {part.gas ? pressure_of_gas(part, volume) : part.pressure, volume};
}

}  // namespace weft
