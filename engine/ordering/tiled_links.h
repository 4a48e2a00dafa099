/// The links of a placement, sorted by tile and coloured.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/placement.h"

namespace weft {

struct TiledLinks {
  struct Place {
    std::uint32_t tile = 0, slot = 0;  // slot within the tile
    auto operator<=>(const Place&) const = default;
  };

  TiledLinks(const Placement& placement, std::span<const Link> links, std::size_t particles);

  std::vector<Place> place_of;                     // by particle
  std::vector<std::vector<std::uint32_t>> within;  // links of each tile
  std::vector<std::uint32_t> between;              // links from tile to tile
  std::vector<std::uint32_t> colour;               // by link; unique at each particle, without gaps
  std::uint32_t colours = 0;

 private:
  Place first_place(const Link& link) const { return std::min(place_of[link.a], place_of[link.b]); }
  void sort(const Placement& placement, std::span<const Link> links);
  void colour_within(const Placement& placement, std::span<const Link> links);
  void close_gaps();
  void colour_between(std::span<const Link> links);
};

}  // namespace weft
