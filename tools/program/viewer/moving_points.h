/// Points that move, as integers: multiples of a quantum from an origin. Each sample is three lists
/// of integers (integers.h), of all x, of all y and of all z. In them stands
///
///   sample 0     the difference from the point before it
///   sample 1     the difference from sample 0
///   sample t     the difference from 2 (sample t - 1) - (sample t - 2), where it would come to by
///   itself
///
/// A coordinate is wrong by half a quantum at most. Coordinates beyond 2^28 quanta are cut there.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weft::tools {

class MovingPoints {
 public:
  MovingPoints(Vec3 origin, double quantum) : origin_(origin), quantum_(quantum) {}
  /// All samples have the same number of points.
  void add_sample(std::span<const Vec3> points);
  const std::string& bytes() const { return bytes_; }

 private:
  using Quanta = std::vector<std::int32_t>;
  void add_axis(std::size_t axis, const Quanta& quanta);

  Vec3 origin_;
  double quantum_;
  std::array<Quanta, 3> last_, before_;  // by axis
  int samples_ = 0;
  std::string bytes_;
};

/// The nearest multiple, within 2^28.
std::int32_t quanta_of(double value, double quantum);

}  // namespace weft::tools
