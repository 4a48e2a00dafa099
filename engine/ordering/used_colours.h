/// The set of colours in use at each particle: one word of 64 bits, and more words only where they
/// are needed.
#pragma once

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace weft {

class UsedColours {
 public:
  explicit UsedColours(std::size_t particles) : low_(particles) {}

  void insert(std::uint32_t particle, std::uint32_t colour) {
    const std::uint64_t bit = std::uint64_t{1} << (colour % 64);
    if (colour < 64) {
      low_[particle] |= bit;
      return;
    }
    std::vector<std::uint64_t>& words = high_[particle];
    const std::size_t i = colour / 64 - 1;
    if (i >= words.size()) words.resize(i + 1);
    words[i] |= bit;
  }

  /// The lowest colour, not below `least`, that is free at all the particles.
  template <class Particles>
  std::uint32_t lowest_free(const Particles& particles, std::uint32_t least = 0) const {
    for (std::uint32_t i = least / 64;; ++i) {
      std::uint64_t used = i == least / 64 ? (std::uint64_t{1} << (least % 64)) - 1 : 0;
      for (const std::uint32_t particle : particles) used |= word(particle, i);
      if (~used != 0) return 64 * i + static_cast<std::uint32_t>(std::countr_one(used));
    }
  }

 private:
  std::uint64_t word(std::uint32_t particle, std::uint32_t i) const {
    if (i == 0) return low_[particle];
    const auto words = high_.find(particle);
    return words != high_.end() && i - 1 < words->second.size() ? words->second[i - 1] : 0;
  }

  std::vector<std::uint64_t> low_;
  std::unordered_map<std::uint32_t, std::vector<std::uint64_t>> high_;
};

}  // namespace weft
