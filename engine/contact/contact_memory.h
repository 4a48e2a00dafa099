/// The multipliers of contacts for the warm start of the next substep: a part of the state of a
/// cloth.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/saving/archive.h"
#include "kernels/vectors.h"

namespace weft {

/// Multipliers of pairs that touch, by their keys, which ascend.
struct ContactMemory {
  static constexpr std::size_t kPerPair = 5;

  double give = 0;                  // s^2: (b h)^2 of their substep
  std::vector<std::uint64_t> keys;  // Pair::key()
  /// kPerPair each: along the normal, x y z of friction, and along the normal in the substep
  /// before.
  std::vector<float> multipliers;

  void clear() {
    give = 0;
    keys.clear();
    multipliers.clear();
  }
  /// Each has its own, and keys ascend.
  bool is_whole() const {
    return multipliers.size() == kPerPair * keys.size() && std::ranges::is_sorted(keys) &&
           std::ranges::all_of(multipliers, [](float m) { return std::isfinite(m); }) &&
           std::isfinite(give) && give >= 0;
  }
  /// by: of a vector.
  template <class Turned>
  void turn(Turned&& by) {
    for (std::size_t i = 0; i + 3 < multipliers.size(); i += kPerPair) {
      const kernels::Vector to = by(kernels::Vector{
          double{multipliers[i + 1]}, double{multipliers[i + 2]}, double{multipliers[i + 3]}});
      multipliers[i + 1] = static_cast<float>(to.x);
      multipliers[i + 2] = static_cast<float>(to.y);
      multipliers[i + 3] = static_cast<float>(to.z);
    }
  }
  std::size_t bytes() const { return bytes_of(keys) + bytes_of(multipliers); }

  friend void visit_fields(Is<ContactMemory> auto& memory, auto& archive) {
    auto& [give, keys, multipliers] = memory;
    archive(give, keys, multipliers);
  }
};

}  // namespace weft
