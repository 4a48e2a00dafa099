/// Integers in few bytes: those that are near 0 take few bits.
///
/// They stand in blocks of 256, of which the last of a list may be shorter. A block is a byte k,
/// then each integer as a Rice code, then bits 0 up to the end of a byte. Bits fill a byte from the
/// lowest one. With z = 2 v for v >= 0 and -2 v - 1 for v < 0 the code is z >> k ones, a zero and
/// the lowest k bits of z; where the ones would be 24 or more, 24 ones and the 32 bits of z.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace weft::tools {

inline constexpr std::size_t kIntegerBlock = 256;
inline constexpr std::uint32_t kMostOnes = 24;

/// Appends a list to the bytes.
void append_integers(std::string& bytes, std::span<const std::int32_t> list);

/// The same of the differences: the first integer, then each less the one before it. They are below
/// 2^31 in size.
void append_differences(std::string& bytes, std::span<const std::int32_t> list);

}  // namespace weft::tools
