#include "engine/colouring.h"

#include <algorithm>
#include <bit>

namespace weft {
namespace {

/// A growing bit set of the colours in use at one particle.
class ColourSet {
 public:
  std::uint64_t word(std::size_t i) const { return i < words_.size() ? words_[i] : 0; }
  std::size_t words() const { return words_.size(); }
  void insert(std::uint32_t colour) {
    const std::size_t i = colour / 64;
    if (i >= words_.size()) words_.resize(i + 1);
    words_[i] |= std::uint64_t{1} << (colour % 64);
  }

 private:
  std::vector<std::uint64_t> words_;
};

std::uint32_t lowest_free_in_both(const ColourSet& a, const ColourSet& b) {
  const std::size_t words = std::max(a.words(), b.words());
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t used = a.word(i) | b.word(i);
    if (~used != 0)
      return static_cast<std::uint32_t>(64 * i) + static_cast<std::uint32_t>(std::countr_one(used));
  }
  return static_cast<std::uint32_t>(64 * words);
}

}  // namespace

Colouring colour_pairs(std::span<const Pair> pairs, std::size_t particles) {
  Colouring result;
  result.colour.reserve(pairs.size());
  std::vector<ColourSet> used(particles);
  for (const Pair& pair : pairs) {
    const std::uint32_t colour = lowest_free_in_both(used[pair.a], used[pair.b]);
    used[pair.a].insert(colour);
    used[pair.b].insert(colour);
    result.colour.push_back(colour);
    result.count = std::max(result.count, colour + 1);
  }
  return result;
}

}  // namespace weft
