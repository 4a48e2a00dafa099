/// Near pairs in blocks no two of which move the same point, so that lanes push them apart at once
/// and each is pushed as if it came alone. Those that may be expected to touch come first: their
/// blocks are full, and the others are seldom looked at. The order follows from that of the pairs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/near_pairs.h"
#include "engine/contact/points.h"

namespace weft {

class Arrangement {
 public:
  void arrange(const ContactPoints& points, NearPairs& near);
  std::size_t bytes() const;

 private:
  struct Block {
    std::size_t first = 0, count = 0;  // in the order
  };
  void place(const ContactPoints& points, const NearPairs& near, std::uint32_t pair);
  std::uint32_t open();
  void close(const NearPairs& near, std::uint32_t block);

  std::vector<std::uint32_t> order_;
  std::array<Block, 64> blocks_;        // that are not full
  std::uint64_t are_open_ = 0;          // a bit for each
  std::vector<std::uint64_t> used_in_;  // likewise, per point
  NearPairs spare_;
};

}  // namespace weft
