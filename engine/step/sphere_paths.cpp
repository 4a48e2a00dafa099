#include "engine/step/sphere_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {
namespace {

/// x + v t + a t^2 / 2, along one axis, and the range of places that matter.
struct AxisPath {
  double x = 0, v = 0, a = 0;
  double low = 0, high = 0;

  bool is_inside(double t) const {
    const double at = x + v * t + 0.5 * a * t * t;
    return low <= at && at <= high;
  }
  /// Adds the times at which it is at the border.
  void add_times(std::vector<double>& times) const {
    for (const double border : {low, high}) {
      const double way = border - x;
      const double root = std::sqrt(v * v + 2 * a * way);  // no number where it never gets there
      for (const double t : {way / v, (-v + root) / a, (-v - root) / a}) {
        if (t > 0 && std::isfinite(t)) times.push_back(t);
      }
    }
  }
};

/// Whether it is ever inside of all three ranges: this changes at borders alone.
bool is_ever_inside(const std::array<AxisPath, 3>& path) {
  std::vector<double> times{0};
  for (const AxisPath& axis : path) axis.add_times(times);
  std::ranges::sort(times);
  times.push_back(times.back() + 1);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double t = 0.5 * (times[i] + times[i + 1]);
    if (std::ranges::all_of(path, [&](const AxisPath& axis) { return axis.is_inside(t); }))
      return true;
  }
  return false;
}

}  // namespace

bool may_come_to_cloth(const Model& model, std::uint32_t sphere) {
  if (model.holds.empty() || model.anchors.size() > 0 || model.is_sphere_joined(sphere))
    return true;
  const double reach =
      model.small_steps().load.reach + model.radius[sphere] + std::ranges::max(model.radius);
  const auto along = [&](double kernels::Vector::*axis) {
    const auto place = [&](std::uint32_t slot) {
      const kernels::Vector at = model.initial_position[slot];
      return at.*axis;
    };
    const std::uint32_t lowest = std::ranges::min(model.holds, {}, place);
    const std::uint32_t highest = std::ranges::max(model.holds, {}, place);
    const kernels::Vector v = model.initial_velocity[sphere];
    return AxisPath{place(sphere), v.*axis, model.gravity.*axis, place(lowest) - reach,
                    place(highest) + reach};
  };
  return is_ever_inside(
      {along(&kernels::Vector::x), along(&kernels::Vector::y), along(&kernels::Vector::z)});
}

}  // namespace weft
