/// Cloths whose states are saved and loaded: one for each solver, and for each part of a state.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weft::fuzz {

using Bytes = std::vector<std::byte>;

inline constexpr std::size_t kSavedCloths = 8;
/// As it begins.
Cloth saved_cloth(std::size_t kind);
/// With bodies, on its way.
Cloth saved_cloth_on_its_way(std::size_t kind);

/// What weft has saved consists of a seal, and of content: for states the fingerprint of the model
/// and all else.
inline constexpr std::size_t kSealSize = 28;
inline constexpr std::size_t kFingerprintSize = 8;

/// Bytes of the kind of `saved`, with this content and a checksum that is right.
Bytes sealed_like(std::span<const std::byte> saved, std::span<const std::byte> content);

inline Bytes joined(std::span<const std::byte> a, std::span<const std::byte> b) {
  Bytes both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

/// What a state that was loaded does: it is saved as the same bytes, and steps.
void use_loaded(Cloth& cloth, std::size_t kind);

}  // namespace weft::fuzz
