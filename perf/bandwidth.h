/// How fast this machine copies memory, per level of its caches: what a kernel's traffic is held
/// against.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace weft::perf {

class Bandwidth {
 public:
  /// Measures, each level with a footprint well inside it; a few tenths of a second.
  Bandwidth();

  struct Level {
    std::string_view name;
    std::size_t size = 0;         // bytes: the largest footprint that belongs here
    double bytes_per_second = 0;  // read + written
  };
  /// Where a footprint of so many bytes belongs.
  const Level& level(double footprint) const;
  const std::array<Level, 4>& levels() const { return levels_; }

 private:
  std::array<Level, 4> levels_;  // L1, L2, L3, DRAM
};

}  // namespace weft::perf
