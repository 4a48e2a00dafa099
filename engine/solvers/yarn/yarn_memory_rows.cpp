#include "engine/solvers/yarn/yarn_memory_rows.h"

#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::kLanes;
using Slots = SlotRows::Slots;

/// A range of rows of the layout.
struct Range {
  std::size_t first = 0, last = 0;
};

Range rows_of_family(const YarnLayout& layout, std::size_t f) {
  if (layout.family_begin[f] == layout.family_begin[f + 1]) return {};
  return {layout.blocks[layout.family_begin[f]].first,
          layout.blocks[layout.family_begin[f + 1] - 1].last};
}

/// Whether the four slots are consecutive, with padding at most at the end (simd::WovenRow).
bool is_four(const SlotRows& rows, Slots four) {
  const std::uint32_t own = rows.count(four);
  for (std::uint32_t k = 0; k < own; ++k) {
    if (!rows.real(four[k]) || four[k] != four[0] + k) return false;
  }
  return true;
}

bool is_within_a_tile(const SlotRows& rows, Slots slots) {
  const auto& tiles = rows.model.ordering.tiles;
  const auto tile = std::ranges::upper_bound(tiles, slots[0], {}, &Tile::last_slot);
  if (tile == tiles.end()) return false;
  return std::ranges::all_of(slots, [&](std::uint32_t slot) {
    return !rows.real(slot) || (tile->first_slot <= slot && slot < tile->last_slot);
  });
}

bool is_in_fours(const SlotRows& rows, Slots slots) {
  bool in_fours = true;
  for (std::uint32_t lane = 0; lane < kLanes; lane += 4) {
    in_fours = in_fours && is_four(rows, slots.subspan(lane, 4));
  }
  return in_fours && is_within_a_tile(rows, slots);
}

std::size_t particles_in_fours(const SlotRows& slots, Range rows) {
  std::size_t particles = 0;
  for (std::size_t row = rows.first; row < rows.last; ++row) {
    if (is_in_fours(slots, slots.of(row))) particles += slots.count(slots.of(row));
  }
  return particles;
}

simd::WovenRow woven_row(const SlotRows& rows, Slots slots, std::uint32_t place) {
  simd::WovenRow row{place, {}, {}, true};
  for (std::uint32_t i = 0; i < simd::WovenRow::kFours; ++i) {
    const Slots four = slots.subspan(4 * i, 4);
    row.count[i] = static_cast<std::uint8_t>(rows.count(four));
    row.four[i] = row.count[i] > 0 ? four[0] : 0;
    row.in_a_row = row.in_a_row && row.count[i] == 4 && row.four[i] == row.four[0] + 4 * i;
  }
  return row;
}

void place_family(const SlotRows& slots, Range rows, YarnHome& home) {
  YarnPlaces& places = home.places;
  for (std::size_t row = rows.first; row < rows.last; ++row, ++home.rows) {
    const Slots own = slots.of(row);
    const auto place = static_cast<std::uint32_t>(home.rows * simd::kRowFloats);
    const bool in_fours = is_in_fours(slots, own);
    if (in_fours) {
      places.rows.push_back(woven_row(slots, own, place));
    } else {
      places.loose_rows.push_back(place);
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      if (!slots.real(own[lane])) continue;
      places.place[own[lane]] = place + lane;
      if (!in_fours) places.loose.push_back({own[lane], place + lane});
    }
  }
  std::ranges::sort(places.rows, {}, [](const simd::WovenRow& row) { return row.four[0]; });
}

/// Places the particles that are on no yarn of the home family.
void place_others(const Model& model, YarnHome& home) {
  YarnPlaces& places = home.places;
  std::uint32_t lane = 0;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (places.place[slot] != kNoIndex || !model.is_particle(slot)) continue;
    places.place[slot] = static_cast<std::uint32_t>(home.rows * simd::kRowFloats + lane);
    places.loose.push_back({slot, places.place[slot]});
    if (++lane < kLanes) continue;
    lane = 0;
    ++home.rows;
  }
  if (lane > 0) ++home.rows;
  places.padding = home.rows * simd::kRowFloats;
  std::ranges::sort(places.loose, {}, &YarnPlaces::Loose::slot);
}

}  // namespace

std::optional<YarnHome> find_home(const SlotRows& slots) {
  const auto& [model, layout] = slots;
  YarnHome home;
  std::size_t most = 0;
  for (std::size_t f = 0; f < layout.families(); ++f) {
    const std::size_t particles = particles_in_fours(slots, rows_of_family(layout, f));
    if (particles <= most) continue;
    most = particles;
    home.family = f;
  }
  if (most == 0) return std::nullopt;
  const Range rows = rows_of_family(layout, home.family);
  const bool is_sparse = (rows.last - rows.first) * kLanes > tuning::kMostLanesPerParticle * most;
  const bool few =
      static_cast<double>(most) < tuning::kLeastWoven * static_cast<double>(model.particles);
  if (is_sparse || few) return std::nullopt;
  home.places.stride = kLanes;
  home.places.place.assign(model.slots(), kNoIndex);
  place_family(slots, rows, home);
  place_others(model, home);
  return home;
}

}  // namespace weft
