/// Multipliers of contacts while these are found anew, by the keys of their pairs: a table with
/// open addressing, which is filled and read once an interval.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/contact/contact_memory.h"

namespace weft {

using Multiplier = std::array<float, ContactMemory::kPerPair>;  // ContactMemory::multipliers

class KnownMultipliers {
 public:
  struct Known {
    std::uint64_t key = 0;
    Multiplier multiplier{};
  };
  /// Those that were known are forgotten.
  void begin() { known_.clear(); }
  /// Each key once.
  void add(std::uint64_t key, const Multiplier& multiplier) { known_.push_back({key, multiplier}); }
  /// All are there.
  void end() {
    places_.assign(std::bit_ceil(4 * known_.size() + 1), kNobody);
    for (std::uint32_t i = 0; i < known_.size(); ++i) {
      std::size_t at = place(known_[i].key);
      while (places_[at] != kNobody) at = next(at);
      places_[at] = i;
    }
  }
  /// Null where it is not known.
  const Multiplier* find(std::uint64_t key) const {
    for (std::size_t at = place(key); places_[at] != kNobody; at = next(at)) {
      const Known& known = known_[places_[at]];
      if (known.key == key) return &known.multiplier;
    }
    return nullptr;
  }
  /// In the order in which they were added.
  std::vector<Known>& all() { return known_; }
  std::size_t bytes() const { return bytes_of(known_) + bytes_of(places_); }

 private:
  static constexpr std::uint32_t kNobody = 0xffffffffu;
  /// By the upper digits of a product (Fibonacci hashing). Features of neighbours have numbers at
  /// equal distances, and their products fall into few places unless both are mixed first.
  std::size_t place(std::uint64_t key) const {
    const int digits = std::countr_zero(places_.size());  // of a power of two
    const std::uint64_t mixed = (key ^ key >> 32) * 0xd6e8feb86659fd93u;
    const std::uint64_t product = (mixed ^ mixed >> 32) * 0x9e3779b97f4a7c15u;
    return digits == 0 ? 0 : static_cast<std::size_t>(product >> (64 - digits));
  }
  std::size_t next(std::size_t at) const { return (at + 1) & (places_.size() - 1); }

  std::vector<Known> known_;
  std::vector<std::uint32_t> places_;  // in known_
};

}  // namespace weft
