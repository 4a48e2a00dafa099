/// Random scenes that are the same on every machine: the generator and what is made of its bits are
/// both fixed (the standard's distributions are not).
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <random>
#include <vector>

namespace weft::test {

class Random {
 public:
  explicit Random(std::uint32_t seed) : bits_(seed) {}
  double between(double low, double high);
  std::uint32_t below(std::uint32_t bound);
  Vec3 in_box(double half_width);
  std::vector<std::uint32_t> permutation(std::size_t count);

 private:
  std::mt19937 bits_;
};

/// A free sheet of size x size particles, 0.1 m apart, every edge at rest, with random masses from
/// 0.5 to 2 kg and random velocities up to 1 m/s per axis; no gravity, nothing fixed.
SceneDescription drifting_sheet(int size, std::uint32_t seed);

}  // namespace weft::test
