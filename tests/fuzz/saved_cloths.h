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

/// An input of a target. The first byte says of which cloth the rest is, and whether that is all
/// that was saved, or its content alone, which is to be sealed rightly.
struct SavedInput {
  std::size_t kind = 0;
  bool is_whole = false;
  std::span<const std::byte> rest{};

  /// like(): what was saved, whose seal the content gets.
  template <class Like>
  Bytes bytes(Like&& like) const {
    return is_whole ? Bytes(rest.begin(), rest.end()) : sealed_like(like(), rest);
  }
};
inline constexpr std::uint8_t kWhole = 0x80;
/// size: at least 1.
inline SavedInput saved_input(const std::uint8_t* data, std::size_t size) {
  return {data[0] % kSavedCloths, (data[0] & kWhole) != 0,
          std::as_bytes(std::span(data + 1, size - 1))};
}

/// What a state that was loaded does: it is saved as the same bytes, and steps.
void use_loaded(Cloth& cloth, std::size_t kind);

}  // namespace weft::fuzz
