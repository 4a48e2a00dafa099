/// The differences between two rows of bytes.
#pragma once

#include <weft/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/saving/archive.h"

namespace weft {

/// Bytes from `at` on are others: so many were removed, and these put in their place.
struct Patch {
  std::uint64_t at = 0, removed = 0;
  std::vector<std::byte> put;

  friend void visit_fields(Is<Patch> auto& patch, auto& archive) {
    auto& [at, removed, put] = patch;
    archive(at, removed, put);
  }
};

/// That make `after` of `before`, in order of the places, which are those in `before`.
std::vector<Patch> patches(std::span<const std::byte> before, std::span<const std::byte> after);

/// The bytes that they make of `before`. An error means that they were not made for it.
Result<std::vector<std::byte>> patched(std::span<const std::byte> before,
                                       std::span<const Patch> patches);

}  // namespace weft
