// Which family of yarns is in place, and which patches the others are cut into.
//
// Woven slots (engine/ordering) follow the rows of a sheet, so that yarns across these stand side
// by side: kLanes of them, row by row, are kLanes slots in a row each time, or fours of slots. They
// make the rows of memory. A yarn along the rows of the sheet goes through the lanes of these, two
// slots apart or in another order; it is the columns that say which particle is where.

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>

#include "engine/model.h"
#include "engine/solvers/yarn_layout.h"
#include "engine/solvers/yarn_places.h"

namespace weft {
namespace {

using kernels::kLanes;

/// A layout is woven where one family has this share of all particles, and has them in fours, in
/// rows of memory that are not half empty; and where of the rows of the others this share is in
/// patches that are not single. Else quads are faster, or as fast.
constexpr double kLeastShare = 0.75;
constexpr std::size_t kMostRoom = 2;  // lanes for each particle
/// Of the particles of a lane, for a patch to be transposed whole.
constexpr int kLeastOfPatch = 4;  // (1 to 4: as fast on sheets)

using Slots = std::span<const std::uint32_t>;

/// Rows of the layout: of a family, a block.
struct Range {
  std::size_t first = 0, last = 0;
};

class Weaver {
 public:
  Weaver(const Model& model, const YarnLayout& layout)
      : model_(model), layout_(layout), place_(model.slots(), kNoIndex) {
    places_.stride = kLanes;
  }

  /// Returns whether it was worth it.
  bool weave() {
    if (!find_home()) return false;
    place_home();
    place_others();
    for (std::size_t f = 0; f < layout_.families(); ++f) {
      for (std::size_t i = layout_.family_begin[f]; i < layout_.family_begin[f + 1]; ++i) {
        if (f == home_) {
          put_in_place(layout_.blocks[i]);
        } else {
          cut_patches(layout_.blocks[i]);
          const bool is_first = i == layout_.family_begin[f];
          if (!is_first)
            blocks_[i - 1].patches_ahead = blocks_[i].last_patch - blocks_[i].first_patch;
        }
      }
    }
    return static_cast<double>(in_patches_) >= kLeastShare * static_cast<double>(across_);
  }
  void apply(YarnLayout& layout) && {
    places_.place = std::move(place_);
    places_.floats = rows_ * simd::kRowFloats;
    layout.places = std::move(places_);
    layout.blocks = std::move(blocks_);
    layout.patches = std::move(patches_);
    layout.slot = std::vector<std::uint32_t>();
  }

 private:
  Slots slots_of(std::size_t row) const {
    return Slots(layout_.slot).subspan(row * kLanes, kLanes);
  }
  bool real(std::uint32_t slot) const { return slot < model_.slots(); }
  Range rows_of_family(std::size_t f) const {
    if (layout_.family_begin[f] == layout_.family_begin[f + 1]) return {};
    return {layout_.blocks[layout_.family_begin[f]].first,
            layout_.blocks[layout_.family_begin[f + 1] - 1].last};
  }

  std::uint32_t count(Slots slots) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(slots, [&](std::uint32_t slot) { return real(slot); }));
  }
  /// Slots in a row and then nobody's; simd::WovenRow.
  bool is_four(Slots four) const {
    const std::uint32_t own = count(four);
    for (std::uint32_t k = 0; k < own; ++k) {
      if (!real(four[k]) || four[k] != four[0] + k) return false;
    }
    return true;
  }
  bool is_in_fours(Slots slots) const {
    bool in_fours = true;
    for (std::uint32_t lane = 0; lane < kLanes; lane += 4) {
      in_fours = in_fours && is_four(slots.subspan(lane, 4));
    }
    return in_fours && within_a_tile(slots);
  }
  bool within_a_tile(Slots slots) const {
    const auto& tiles = model_.ordering.tiles;
    const auto tile = std::ranges::upper_bound(tiles, slots[0], {}, &Tile::last_slot);
    if (tile == tiles.end()) return false;
    return std::ranges::all_of(slots, [&](std::uint32_t slot) {
      return !real(slot) || (tile->first_slot <= slot && slot < tile->last_slot);
    });
  }
  /// The family that has most particles in rows of fours; whether that is enough.
  bool find_home() {
    std::size_t most = 0;
    for (std::size_t f = 0; f < layout_.families(); ++f) {
      const Range rows = rows_of_family(f);
      std::size_t particles = 0;
      for (std::size_t row = rows.first; row < rows.last; ++row) {
        if (is_in_fours(slots_of(row))) particles += count(slots_of(row));
      }
      if (particles <= most) continue;
      most = particles;
      home_ = f;
    }
    if (most == 0) return false;
    const Range rows = rows_of_family(home_);
    const bool roomy = (rows.last - rows.first) * kLanes > kMostRoom * most;
    return !roomy &&
           static_cast<double>(most) >= kLeastShare * static_cast<double>(model_.particles);
  }

  void place_home() {
    const Range rows = rows_of_family(home_);
    for (std::size_t row = rows.first; row < rows.last; ++row, ++rows_) {
      const Slots slots = slots_of(row);
      const auto place = static_cast<std::uint32_t>(rows_ * simd::kRowFloats);
      const bool in_fours = is_in_fours(slots);
      if (in_fours) {
        add_row(slots, place);
      } else {
        places_.loose_rows.push_back(place);
      }
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        if (!real(slots[lane])) continue;
        place_[slots[lane]] = place + lane;
        if (!in_fours) places_.loose.push_back({slots[lane], place + lane});
      }
    }
    std::ranges::sort(places_.rows, {}, [](const simd::WovenRow& row) { return row.four[0]; });
  }
  void add_row(Slots slots, std::uint32_t place) {
    simd::WovenRow row{place, {}, {}, true};
    for (std::uint32_t i = 0; i < simd::WovenRow::kFours; ++i) {
      const Slots four = slots.subspan(4 * i, 4);
      row.count[i] = static_cast<std::uint8_t>(count(four));
      row.four[i] = row.count[i] > 0 ? four[0] : 0;
      row.in_a_row = row.in_a_row && row.count[i] == 4 && row.four[i] == row.four[0] + 4 * i;
    }
    places_.rows.push_back(row);
  }
  /// Particles of no yarn of the home family.
  void place_others() {
    std::uint32_t lane = 0;
    for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
      if (place_[slot] != kNoIndex || model_.ordering.particle_at[slot] == kNoIndex) continue;
      place_[slot] = static_cast<std::uint32_t>(rows_ * simd::kRowFloats + lane);
      places_.loose.push_back({slot, place_[slot]});
      if (++lane < kLanes) continue;
      lane = 0;
      ++rows_;
    }
    if (lane > 0) ++rows_;
    places_.padding = rows_ * simd::kRowFloats;
    std::ranges::sort(places_.loose, {}, &YarnPlaces::Loose::slot);
    particles_.assign(rows_, 0);
    for (const std::uint32_t place : place_) {
      if (place != kNoIndex) particles_[place / simd::kRowFloats] |= 1u << place % simd::kRowFloats;
    }
  }
  void put_in_place(simd::YarnBlock block) {
    block.access = simd::YarnAccess::in_place;
    block.place = place_[slots_of(block.first)[0]];
    blocks_.push_back(block);
  }

  /// Where the particles of a block's row stand: per lane, the row of memory, and, where it is the
  /// same for all of them, the column.
  struct Stand {
    std::array<std::uint32_t, kLanes> memory{};
    std::uint32_t column = kNoIndex;
  };
  Stand stand(Slots slots, std::uint32_t nobody) const {
    Stand stand;
    bool one_column = true;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      stand.memory[lane] = nobody;
      if (!real(slots[lane])) continue;
      const std::uint32_t place = place_[slots[lane]], column = place % simd::kRowFloats;
      stand.memory[lane] = place - column;
      one_column = one_column && (stand.column == kNoIndex || stand.column == column);
      stand.column = column;
    }
    if (!one_column) stand.column = kNoIndex;
    return stand;
  }
  /// Rows of a block whose lanes stand in the same rows of memory make a patch: the row of the
  /// block for each column. Padding lanes share a row of memory that is nobody's.
  using Columns = std::array<std::uint32_t, kLanes>;

  void cut_patches(simd::YarnBlock block) {
    const auto nobody = static_cast<std::uint32_t>(rows_++ * simd::kRowFloats);
    const std::uint32_t rows = block.last - block.first;
    block.access = simd::YarnAccess::patches;
    block.first_patch = static_cast<std::uint32_t>(patches_.size());
    Columns no_columns;
    no_columns.fill(kNoIndex);
    std::map<std::array<std::uint32_t, kLanes>, Columns> found;
    for (std::uint32_t k = 0; k < rows; ++k) {
      const Stand at = stand(slots_of(block.first + k), nobody);
      if (at.column == kNoIndex) {
        add_single(block, k, nobody);
      } else {
        found.try_emplace(at.memory, no_columns).first->second[at.column] = k;
      }
    }
    for (const auto& [memory, columns] : found) {
      if (is_whole(memory, columns, nobody)) {
        add_whole(memory, columns, rows);
        continue;
      }
      for (const std::uint32_t k : columns) {
        if (k != kNoIndex) add_single(block, k, nobody);
      }
    }
    across_ += rows;
    std::sort(patches_.begin() + block.first_patch, patches_.end(),
              [](const auto& one, const auto& two) { return first_row(one) < first_row(two); });
    block.last_patch = static_cast<std::uint32_t>(patches_.size());
    blocks_.push_back(block);
  }
  static std::uint32_t first_row(const simd::YarnPatch& patch) {
    return patch.single ? patch.row[0] : *std::ranges::min_element(patch.row);
  }
  /// Of a good number of columns, in rows of memory that hold nobody else's particles.
  bool is_whole(const std::array<std::uint32_t, kLanes>& memory, const Columns& columns,
                std::uint32_t nobody) const {
    std::uint32_t own = 0, all = 0;
    for (std::uint32_t column = 0; column < kLanes; ++column) {
      if (columns[column] != kNoIndex) own |= 1u << column;
    }
    for (const std::uint32_t place : memory) {
      if (place != nobody) all |= particles_[place / simd::kRowFloats];
    }
    return (all & ~own) == 0 && std::popcount(own) >= kLeastOfPatch;
  }
  void add_whole(const std::array<std::uint32_t, kLanes>& memory, const Columns& columns,
                 std::uint32_t rows) {
    simd::YarnPatch patch{};
    std::ranges::copy(memory, patch.place);
    for (std::uint32_t column = 0; column < kLanes; ++column) {
      const bool own = columns[column] != kNoIndex;
      patch.row[column] = own ? columns[column] : rows;
      if (!own) continue;
      patch.columns = column + 1;
      ++in_patches_;
    }
    patches_.push_back(patch);
  }
  void add_single(const simd::YarnBlock& block, std::uint32_t row, std::uint32_t nobody) {
    const Slots slots = slots_of(block.first + row);
    simd::YarnPatch patch{};
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      patch.place[lane] = real(slots[lane]) ? place_[slots[lane]] : nobody;
    }
    patch.row[0] = row;
    patch.single = true;
    patches_.push_back(patch);
  }

  const Model& model_;
  const YarnLayout& layout_;
  YarnPlaces places_;
  std::vector<std::uint32_t> place_;      // per slot
  std::vector<std::uint32_t> particles_;  // per row of memory, a bit for each
  std::vector<simd::YarnBlock> blocks_;
  std::vector<simd::YarnPatch> patches_;
  std::size_t rows_ = 0;  // of memory
  std::size_t home_ = 0;
  std::size_t across_ = 0, in_patches_ = 0;  // rows of other families
};

}  // namespace

void weave(const Model& model, YarnLayout& layout) {
  Weaver weaver(model, layout);
  if (weaver.weave()) std::move(weaver).apply(layout);
}

}  // namespace weft
