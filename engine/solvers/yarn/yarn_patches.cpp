#include "engine/solvers/yarn/yarn_patches.h"

#include <algorithm>
#include <bit>
#include <map>

#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::kLanes;

std::uint32_t first_row(const simd::YarnPatch& patch) {
  return patch.single ? patch.row[0] : *std::ranges::min_element(patch.row);
}

}  // namespace

YarnPatches::YarnPatches(const SlotRows& slots, const YarnHome& home)
    : slots_(slots), place_(home.places.place), rows_(home.rows), particles_(home.rows) {
  for (const std::uint32_t place : place_) {
    if (place != kNoIndex) particles_[place / simd::kRowFloats] |= 1u << place % simd::kRowFloats;
  }
}

simd::YarnBlock YarnPatches::cut(simd::YarnBlock block) {
  const auto nobody = static_cast<std::uint32_t>(rows_++ * simd::kRowFloats);
  const std::uint32_t rows = block.last - block.first;
  block.access = simd::YarnAccess::patches;
  block.first_patch = static_cast<std::uint32_t>(patches_.size());
  Columns no_columns;
  no_columns.fill(kNoIndex);
  std::map<Memory, Columns> found;
  for (std::uint32_t k = 0; k < rows; ++k) {
    const Stand at = stand(slots_.of(block.first + k), nobody);
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
  cut_ += rows;
  std::sort(patches_.begin() + block.first_patch, patches_.end(),
            [](const auto& one, const auto& two) { return first_row(one) < first_row(two); });
  block.last_patch = static_cast<std::uint32_t>(patches_.size());
  return block;
}

double YarnPatches::share_whole() const {
  return cut_ == 0 ? 1 : static_cast<double>(whole_) / static_cast<double>(cut_);
}

YarnPatches::Stand YarnPatches::stand(SlotRows::Slots slots, std::uint32_t nobody) const {
  Stand stand;
  bool one_column = true;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    stand.memory[lane] = nobody;
    if (!slots_.real(slots[lane])) continue;
    const std::uint32_t place = place_[slots[lane]], column = place % simd::kRowFloats;
    stand.memory[lane] = place - column;
    one_column = one_column && (stand.column == kNoIndex || stand.column == column);
    stand.column = column;
  }
  if (!one_column) stand.column = kNoIndex;
  return stand;
}

/// Whether a patch has enough columns, and its rows of memory have no particles of other yarns.
bool YarnPatches::is_whole(const Memory& memory, const Columns& columns,
                           std::uint32_t nobody) const {
  std::uint32_t own = 0, all = 0;
  for (std::uint32_t column = 0; column < kLanes; ++column) {
    if (columns[column] != kNoIndex) own |= 1u << column;
  }
  for (const std::uint32_t place : memory) {
    if (place != nobody) all |= particles_[place / simd::kRowFloats];
  }
  return (all & ~own) == 0 && std::popcount(own) >= tuning::kLeastOfPatch;
}

void YarnPatches::add_whole(const Memory& memory, const Columns& columns, std::uint32_t rows) {
  simd::YarnPatch patch{};
  std::ranges::copy(memory, patch.place);
  for (std::uint32_t column = 0; column < kLanes; ++column) {
    const bool own = columns[column] != kNoIndex;
    patch.row[column] = own ? columns[column] : rows;
    if (!own) continue;
    patch.columns = column + 1;
    ++whole_;
  }
  patches_.push_back(patch);
}

void YarnPatches::add_single(const simd::YarnBlock& block, std::uint32_t row,
                             std::uint32_t nobody) {
  const SlotRows::Slots slots = slots_.of(block.first + row);
  simd::YarnPatch patch{};
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    patch.place[lane] = slots_.real(slots[lane]) ? place_[slots[lane]] : nobody;
  }
  patch.row[0] = row;
  patch.single = true;
  patches_.push_back(patch);
}

}  // namespace weft
