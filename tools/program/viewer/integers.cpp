#include "tools/program/viewer/integers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace weft::tools {
namespace {

constexpr std::uint32_t kMostLowBits = 24;

std::uint32_t zigzag(std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  return value < 0 ? ~(bits << 1) : bits << 1;
}

std::uint64_t bits_of(std::span<const std::uint32_t> block, std::uint32_t low_bits) {
  std::uint64_t bits = 0;
  for (const std::uint32_t value : block) {
    const std::uint32_t ones = value >> low_bits;
    bits += ones < kMostOnes ? ones + 1 + low_bits : kMostOnes + 32;
  }
  return bits;
}

/// The bits of a block are a convex function of it, but for the integers that are written in full.
std::uint32_t best_low_bits(std::span<const std::uint32_t> block) {
  std::uint32_t best = 0;
  std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
  for (std::uint32_t low_bits = 0; low_bits <= kMostLowBits; ++low_bits) {
    const std::uint64_t bits = bits_of(block, low_bits);
    if (bits >= fewest) continue;
    fewest = bits;
    best = low_bits;
  }
  return best;
}

class BitWriter {
 public:
  explicit BitWriter(std::string& bytes) : bytes_(bytes) {}
  /// The lowest `count` bits, up to 32.
  void add(std::uint32_t value, std::uint32_t count) {
    held_ |= static_cast<std::uint64_t>(value) << held_count_;
    held_count_ += count;
    for (; held_count_ >= 8; held_count_ -= 8, held_ >>= 8) put();
  }
  void finish() {
    if (held_count_ > 0) put();
  }

 private:
  void put() { bytes_.push_back(static_cast<char>(held_ & 0xff)); }
  std::string& bytes_;
  std::uint64_t held_ = 0;
  std::uint32_t held_count_ = 0;
};

void append_block(std::string& bytes, std::span<const std::uint32_t> block) {
  const std::uint32_t low_bits = best_low_bits(block);
  bytes.push_back(static_cast<char>(low_bits));
  BitWriter writer(bytes);
  for (const std::uint32_t value : block) {
    const std::uint32_t ones = std::min(value >> low_bits, kMostOnes);
    writer.add((1u << ones) - 1, ones);
    if (ones == kMostOnes) {
      writer.add(value, 32);
    } else {
      writer.add(0, 1);
      writer.add(value & ((1u << low_bits) - 1), low_bits);
    }
  }
  writer.finish();
}

}  // namespace

void append_integers(std::string& bytes, std::span<const std::int32_t> list) {
  std::array<std::uint32_t, kIntegerBlock> block{};
  for (std::size_t first = 0; first < list.size(); first += kIntegerBlock) {
    const auto part = list.subspan(first, std::min(kIntegerBlock, list.size() - first));
    std::ranges::transform(part, block.begin(), zigzag);
    append_block(bytes, {block.data(), part.size()});
  }
}

void append_differences(std::string& bytes, std::span<const std::int32_t> list) {
  std::vector<std::int32_t> differences(list.begin(), list.end());
  for (std::size_t i = differences.size(); i-- > 1;) differences[i] -= differences[i - 1];
  append_integers(bytes, differences);
}

}  // namespace weft::tools
