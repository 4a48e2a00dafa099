#include "engine/ordering/tiled_links.h"

#include <algorithm>
#include <array>

#include "engine/ordering/used_colours.h"

namespace weft {
namespace {

/// The largest number of colours within a tile, if no particle has more than 16 links. Links
/// between tiles then need at most 31 more, so that a word of 64 bits holds a set of colours.
constexpr std::uint32_t kMostColours = 33;

}  // namespace

TiledLinks::TiledLinks(const Placement& placement, std::span<const Link> links,
                       std::size_t particles)
    : place_of(particles), within(placement.tiles.size()), colour(links.size()) {
  for (std::uint32_t t = 0; t < placement.tiles.size(); ++t) {
    const std::vector<std::uint32_t>& tile = placement.tiles[t];
    for (std::uint32_t slot = 0; slot < tile.size(); ++slot) {
      if (tile[slot] != kNoIndex) place_of[tile[slot]] = {t, slot};
    }
  }
  sort(placement, links);
  colour_within(placement, links);
  close_gaps();
  colour_between(links);
}

/// Sorts the links within a tile by their lower slot. Links between tiles are first sorted by their
/// direction in the lattice, because most of those with one direction can share a colour.
void TiledLinks::sort(const Placement& placement, std::span<const Link> links) {
  for (std::uint32_t i = 0; i < links.size(); ++i) {
    const std::uint32_t tile = place_of[links[i].a].tile;
    (place_of[links[i].b].tile == tile ? within[tile] : between).push_back(i);
  }
  const auto by_slot = [&](std::uint32_t i, std::uint32_t k) {
    return first_place(links[i]) < first_place(links[k]);
  };
  for (auto& tile : within) std::stable_sort(tile.begin(), tile.end(), by_slot);
  const auto direction = [&](std::uint32_t i) { return placement.colour_class[i] / 2; };
  std::stable_sort(between.begin(), between.end(), [&](std::uint32_t i, std::uint32_t k) {
    return direction(i) != direction(k) ? direction(i) < direction(k) : by_slot(i, k);
  });
}

void TiledLinks::colour_within(const Placement& placement, std::span<const Link> links) {
  UsedColours used(place_of.size());
  const auto set = [&](std::uint32_t i, std::uint32_t c) {
    colour[i] = c;
    used.insert(links[i].a, c);
    used.insert(links[i].b, c);
  };
  const std::vector<std::uint32_t>& given = placement.colour_class;
  for (const auto& tile : within) {
    for (const std::uint32_t i : tile) {
      if (given[i] != kNoIndex) set(i, given[i]);
    }
  }
  std::uint32_t classes = 0;
  for (const std::uint32_t c : given) {
    if (c != kNoIndex) classes = std::max(classes, c + 1);
  }
  // The other links first try colours of their own: in the colours of runs they would take slots
  // that padding needs.
  for (const auto& tile : within) {
    for (const std::uint32_t i : tile) {
      if (given[i] != kNoIndex) continue;
      const std::array ends{links[i].a, links[i].b};
      const std::uint32_t c = used.lowest_free(ends, classes);
      set(i, c < kMostColours ? c : used.lowest_free(ends));
    }
  }
}

/// Renumbers the colours without those that no link within a tile has.
void TiledLinks::close_gaps() {
  std::vector<std::uint32_t> number;
  for (const auto& tile : within) {
    for (const std::uint32_t i : tile) {
      if (colour[i] >= number.size()) number.resize(colour[i] + 1, kNoIndex);
      number[colour[i]] = 0;
    }
  }
  for (std::uint32_t& n : number) {
    if (n != kNoIndex) n = colours++;
  }
  for (const auto& tile : within) {
    for (const std::uint32_t i : tile) colour[i] = number[colour[i]];
  }
}

/// Gives links between tiles colours beyond those within the tiles.
void TiledLinks::colour_between(std::span<const Link> links) {
  UsedColours used(place_of.size());
  const std::uint32_t first = colours;
  for (const std::uint32_t i : between) {
    const std::uint32_t c = used.lowest_free(std::array{links[i].a, links[i].b});
    used.insert(links[i].a, c);
    used.insert(links[i].b, c);
    colour[i] = first + c;
    colours = std::max(colours, colour[i] + 1);
  }
}

}  // namespace weft
