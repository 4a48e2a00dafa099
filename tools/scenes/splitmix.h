/// Numbers of chance that are the same on every machine (splitmix64). perf/irregular_mesh draws the
/// same ones.
#pragma once

#include <cmath>
#include <cstdint>

namespace weft::scenes {

class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double unit() { return std::ldexp(static_cast<double>(bits() >> 11), -53); }  // [0, 1)
  std::uint64_t below(std::uint64_t bound) { return bits() % bound; }

 private:
  std::uint64_t state_;
};

}  // namespace weft::scenes
