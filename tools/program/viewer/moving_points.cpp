#include "tools/program/viewer/moving_points.h"

#include <algorithm>
#include <cmath>

#include "tools/program/viewer/integers.h"

namespace weft::tools {

std::int32_t quanta_of(double value, double quantum) {
  constexpr double kMost = 1 << 28;  // four times as much is below 2^31
  return static_cast<std::int32_t>(std::clamp(std::round(value / quantum), -kMost, kMost));
}

void MovingPoints::add_sample(std::span<const Vec3> points) {
  constexpr std::array<double Vec3::*, 3> kAxes{&Vec3::x, &Vec3::y, &Vec3::z};
  Quanta quanta(points.size());
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    const double origin = origin_.*kAxes[axis];
    for (std::size_t i = 0; i < points.size(); ++i)
      quanta[i] = quanta_of(points[i].*kAxes[axis] - origin, quantum_);
    add_axis(axis, quanta);
  }
  ++samples_;
}

void MovingPoints::add_axis(std::size_t axis, const Quanta& quanta) {
  Quanta &last = last_[axis], &before = before_[axis];
  if (samples_ == 0) {
    append_differences(bytes_, quanta);
  } else {
    Quanta rest(quanta.size());
    for (std::size_t i = 0; i < quanta.size(); ++i)
      rest[i] = quanta[i] - (samples_ == 1 ? last[i] : 2 * last[i] - before[i]);
    append_integers(bytes_, rest);
  }
  before = std::move(last);
  last = quanta;
}

}  // namespace weft::tools
