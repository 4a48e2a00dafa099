/// Bytes that detect damage: their kind, version, number and checksum go before them. A single
/// changed byte is always detected; other damage is missed in one case in 2^64.
#pragma once

#include <weft/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weft {

struct Kind {
  std::array<char, 8> mark;
  const char* name;
  std::uint32_t version;
};

std::vector<std::byte> seal(const Kind& kind, std::span<const std::byte> content);
/// The content, in these bytes. An error says why it is none: "state: is damaged (...)".
Result<std::span<const std::byte>> unseal(const Kind& kind, std::span<const std::byte> bytes);

/// The checksum of any bytes.
std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace weft
