/// The steps across a lattice that links make, and the colours that follow from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/lattice.h"
#include "engine/ordering/ordering.h"

namespace weft {

/// From the lower end of a link to the upper: rows > 0, or rows = 0 and columns > 0.
struct Step {
  std::int32_t rows = 0, columns = 0;
  auto operator<=>(const Step&) const = default;
};

/// The steps that many links make.
class Steps {
 public:
  /// After how many rows and columns the colours repeat.
  struct Period {
    std::uint32_t rows = 2, columns = 2;
  };

  Steps(std::span<const Cell> cells, std::span<const Link> links);

  /// Two classes for each step, 2 k and 2 k + 1: along step (r, c) they alternate every r rows, or
  /// every c columns where r = 0. So a particle is the lower end of one link of a class or the
  /// upper end of one, and never both. kNoIndex: not one of the frequent steps.
  std::uint32_t colour_class(const Link& link) const;
  Period period() const;

 private:
  bool is_within_part(const Link& link) const { return cells_[link.a].part == cells_[link.b].part; }
  Step step(const Link& link) const;

  std::span<const Cell> cells_;
  std::vector<Step> frequent_;  // ascending
};

}  // namespace weft
