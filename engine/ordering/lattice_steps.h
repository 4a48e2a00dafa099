/// The steps that links make across a lattice, and the colours that follow from them.
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
  /// The numbers of rows and columns after which the colours repeat.
  struct Period {
    std::uint32_t rows = 2, columns = 2;
  };

  Steps(std::span<const Cell> cells, std::span<const Link> links);

  /// Step k has two classes, 2 k and 2 k + 1. Those of the step (r, c) alternate every r rows, or
  /// every c columns where r = 0, so that a particle is never an end of two links of one class.
  /// Returns kNoIndex if the step is not one of the frequent ones.
  std::uint32_t colour_class(const Link& link) const;
  Period period() const;

 private:
  bool is_within_part(const Link& link) const { return cells_[link.a].part == cells_[link.b].part; }
  Step step(const Link& link) const;

  std::span<const Cell> cells_;
  std::vector<Step> frequent_;  // ascending
};

}  // namespace weft
