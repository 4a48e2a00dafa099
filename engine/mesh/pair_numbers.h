/// Numbers for pairs of particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/mesh/pair_key.h"

namespace weft::mesh {

/// Numbers pairs 0, 1, 2 and so on, in the order in which they are first added. A hash table with
/// open addresses: a mesh has some hundred thousand edges, and each is looked up several times.
class PairNumbers {
 public:
  /// expected: how many pairs there will be; more are possible.
  explicit PairNumbers(std::size_t expected = 0) { resize(2 * expected); }

  /// The number of the pair, and whether it is new.
  std::pair<std::uint32_t, bool> add(std::uint32_t a, std::uint32_t b) {
    if (2 * (keys_.size() + 1) > table_.size()) resize(2 * table_.size());
    const std::uint64_t key = pair_key(a, b);
    std::uint32_t& entry = table_[place_of(key)];
    if (entry != kEmpty) return {entry, false};
    entry = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
    return {entry, true};
  }

  bool contains(std::uint32_t a, std::uint32_t b) const {
    return table_[place_of(pair_key(a, b))] != kEmpty;
  }

  std::size_t size() const { return keys_.size(); }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;

  /// Where the key is, or where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = table_.size() - 1;
    // The upper bits of a product depend on all bits of the key.
    std::size_t place = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 32) & mask;
    while (table_[place] != kEmpty && keys_[table_[place]] != key) place = (place + 1) & mask;
    return place;
  }

  void resize(std::size_t least) {
    std::size_t size = 16;
    while (size < least) size *= 2;
    table_.assign(size, kEmpty);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) table_[place_of(keys_[i])] = i;
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> table_;  ///< numbers; a power of two, at most half full
};

}  // namespace weft::mesh
