/// Anchors where small steps in lanes find them: in blocks of kLanes particles that stand in a row
/// of memory, of which one at least has an anchor.
#pragma once

#include <cstdint>
#include <vector>

namespace weft {

class Model;
struct YarnPlaces;

struct AnchorLayout {
  std::vector<std::uint32_t> place;    // per block: of its first particle
  std::vector<std::uint32_t> anchor;   // per block and lane: of the model, or kNoIndex
  std::vector<std::int32_t> backstop;  // per block: its number among those with one, or -1
  std::vector<double> shortest;        // per anchor: m, of its particle's constraints, or infinite
  std::uint32_t backstops = 0;

  bool empty() const { return place.empty(); }
  std::size_t bytes() const;
};

AnchorLayout make_anchor_layout(const Model& model, const YarnPlaces& places);

}  // namespace weft
