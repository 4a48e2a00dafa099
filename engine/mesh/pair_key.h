/// Two particles as one number, whichever comes first.
#pragma once

#include <algorithm>
#include <cstdint>

namespace weft::mesh {

inline std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

}  // namespace weft::mesh
