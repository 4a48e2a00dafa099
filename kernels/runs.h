/// The unit of contiguous work that the vector kernels take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace weft::kernels {

inline constexpr std::uint32_t kLanes = 16;  // of the widest vector, whatever the machine has
/// About two cores' own caches. Arrays that are larger come from memory in every pass.
inline constexpr std::size_t kCachedBytes = std::size_t{4} << 20;

/// The least multiple that is not less.
template <class Int>
constexpr Int round_up(Int value, std::type_identity_t<Int> multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// Constraint slot constraint + k joins the particle slots a + k and b + k, k < length. No slot
/// occurs twice.
struct Run {
  std::uint32_t a = 0, b = 0;    // first slots
  std::uint32_t constraint = 0;  // first constraint slot
  std::uint32_t length = 0;      // multiple of kLanes
};

}  // namespace weft::kernels
