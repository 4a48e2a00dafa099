#include "engine/measure/simd_layout.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

std::uint32_t count_real(const Ordering& ordering, std::uint32_t first, std::uint32_t length) {
  const auto begin = ordering.link_at.begin() + first;
  return static_cast<std::uint32_t>(
      std::count_if(begin, begin + length, [](std::uint32_t link) { return link != kNoIndex; }));
}

/// Cuts a run, or singles, of a batch into chunks.
void cut(const Ordering& ordering, const Batch& batch, const kernels::Run& run, bool singles,
         std::vector<Chunk>& chunks) {
  for (std::uint32_t k = 0; k < run.length; k += kChunk) {
    Chunk chunk;
    chunk.run = {run.a + k, run.b + k, run.constraint + k, std::min(kChunk, run.length - k)};
    chunk.real = count_real(ordering, chunk.run.constraint, chunk.run.length);
    chunk.singles = singles;
    chunk.rope = batch.kind == ConstraintKind::rope;
    chunks.push_back(chunk);
  }
}

void cut_batches(const Ordering& ordering, SimdLayout& layout) {
  for (const Batch& batch : ordering.batches) {
    layout.batch_chunks.push_back(static_cast<std::uint32_t>(layout.chunks.size()));
    for (std::uint32_t r = batch.first_run; r < batch.last_run; ++r) {
      cut(ordering, batch, ordering.runs[r], false, layout.chunks);
    }
    layout.batch_singles.push_back(static_cast<std::uint32_t>(layout.chunks.size()));
    const kernels::Run singles{0, 0, batch.singles, batch.last - batch.singles};
    cut(ordering, batch, singles, true, layout.chunks);
  }
  layout.batch_chunks.push_back(static_cast<std::uint32_t>(layout.chunks.size()));
  for (const Chunk& chunk : layout.chunks) layout.runs.push_back(chunk.run);
}

/// The tile of a slot; the number of tiles for those that are in none.
std::uint32_t tile_of(const Ordering& ordering, std::uint32_t slot) {
  const auto tile = std::ranges::upper_bound(ordering.tiles, slot, {}, &Tile::last_slot);
  return static_cast<std::uint32_t>(tile - ordering.tiles.begin());
}

struct TilesOfChunk {
  std::uint32_t chunk, first, last;
};

/// Padding counts: it is written to.
TilesOfChunk tiles_of(const Ordering& ordering, const SimdLayout& layout, std::uint32_t chunk) {
  TilesOfChunk tiles{chunk, kNoIndex, 0};
  const kernels::Run& run = layout.chunks[chunk].run;
  for (std::uint32_t c = run.constraint; c < run.constraint + run.length; ++c) {
    for (const std::uint32_t slot : {layout.a[c], layout.b[c]}) {
      tiles.first = std::min(tiles.first, tile_of(ordering, slot));
      tiles.last = std::max(tiles.last, tile_of(ordering, slot));
    }
  }
  return tiles;
}

void find_seams(const Ordering& ordering, SimdLayout& layout) {
  std::vector<TilesOfChunk> chunks;
  if (ordering.tiles.size() > 1 && ordering.between_tiles < ordering.batches.size()) {
    const std::uint32_t last = layout.batch_chunks[ordering.between_tiles + 1];
    for (std::uint32_t i = layout.batch_chunks[ordering.between_tiles]; i < last; ++i) {
      chunks.push_back(tiles_of(ordering, layout, i));
    }
  }
  std::ranges::stable_sort(chunks, {}, &TilesOfChunk::last);
  auto next = chunks.begin();
  for (std::uint32_t tile = 0; tile <= ordering.tiles.size(); ++tile) {
    layout.seams_at.push_back(static_cast<std::uint32_t>(layout.seams.size()));
    for (; next != chunks.end() && next->last == tile; ++next) {
      const bool longer = layout.seams.size() > layout.seams_at.back() &&
                          layout.seams.back().last_chunk == next->chunk &&
                          layout.seams.back().first_tile == next->first;
      if (!longer) layout.seams.push_back({next->chunk, next->chunk, next->first});
      ++layout.seams.back().last_chunk;
      layout.seams_join_neighbours &= tile <= next->first + 1;
    }
  }
  layout.seams_at.push_back(static_cast<std::uint32_t>(layout.seams.size()));
}

/// The slots of a chunk's real constraints.
template <class Visit>
void for_each_slot(const SimdLayout& layout, const Chunk& chunk, Visit&& visit) {
  for (std::uint32_t k = 0; k < chunk.run.length; ++k) {
    const std::uint32_t c = chunk.run.constraint + k;
    if (layout.constraint_at[c] == kNoIndex) continue;
    visit(layout.a[c]);
    visit(layout.b[c]);
  }
}

void place(SimdLayout& layout, std::uint32_t slot, std::uint32_t constraint,
           const ConstraintStore& store, const kernels::AlignedVector<double>& inverse_mass) {
  const std::uint32_t a = store.a[constraint], b = store.b[constraint];
  const double sum = inverse_mass[a] + inverse_mass[b];
  layout.a[slot] = a;
  layout.b[slot] = b;
  layout.constraint_at[slot] = constraint;
  const double rest = store.rest_length[constraint];
  layout.rest_length[slot] = rest;
  layout.inverse_square[slot] = 1 / (rest * rest);
  layout.share_a[slot] = inverse_mass[a] / sum;
  layout.share_b[slot] = inverse_mass[b] / sum;
  if (constraint >= store.bilateral) layout.has_ropes = true;
}

void find_stiffness(const ConstraintStore& store, SimdLayout& layout) {
  layout.compliance.assign(layout.constraint_slots, std::numeric_limits<double>::infinity());
  layout.inverse_mass.assign(layout.constraint_slots, 0);
  for (std::size_t slot = 0; slot < layout.constraint_slots; ++slot) {
    const std::uint32_t c = layout.constraint_at[slot];
    if (c == kNoIndex || store.compliance[c] == 0) continue;
    layout.compliance[slot] = store.compliance[c];
    layout.inverse_mass[slot] = 1 / store.effective_mass[c];
  }
}

}  // namespace

SimdLayout make_simd_layout(const Model& model) {
  const Ordering& ordering = model.ordering;
  const ConstraintStore& store = model.constraints;
  const auto& inverse_mass = model.inverse_mass;
  SimdLayout layout;
  layout.slots = ordering.slots();
  const auto batched = static_cast<std::uint32_t>(ordering.constraint_slots());
  const auto hubs = static_cast<std::uint32_t>(store.hub_distances.size() + store.hub_ropes.size());
  layout.hub_first = batched;
  layout.hub_ropes = batched + static_cast<std::uint32_t>(store.hub_distances.size());
  layout.hub_last = batched + hubs;
  layout.constraint_slots = batched + kernels::round_up(hubs, kernels::kLanes);
  layout.a = ordering.a;
  layout.b = ordering.b;
  layout.a.resize(layout.constraint_slots);
  layout.b.resize(layout.constraint_slots);
  layout.constraint_at.assign(layout.constraint_slots, kNoIndex);
  layout.rest_length.assign(layout.constraint_slots, 1);
  layout.inverse_square.assign(layout.constraint_slots, 0);
  layout.share_a.resize(layout.constraint_slots);
  layout.share_b.resize(layout.constraint_slots);
  for (std::uint32_t c = 0; c < store.size(); ++c) {
    if (store.slot[c] != kNoIndex) place(layout, store.slot[c], c, store, inverse_mass);
  }
  std::uint32_t next = batched;
  for (const auto* list : {&store.hub_distances, &store.hub_ropes}) {
    for (const std::uint32_t c : *list) place(layout, next++, c, store, inverse_mass);
  }
  if (store.has_springs()) find_stiffness(store, layout);
  cut_batches(ordering, layout);
  find_seams(ordering, layout);
  return layout;
}

ChunkNeighbours find_chunk_neighbours(const SimdLayout& layout) {
  ChunkNeighbours neighbours;
  neighbours.at = make_lists(layout.slots, [&](auto&& add) {
    for (std::uint32_t i = 0; i < layout.chunks.size(); ++i) {
      for_each_slot(layout, layout.chunks[i], [&](std::uint32_t s) { add(s, i); });
    }
  });
  std::vector<std::uint32_t> list;
  for (std::uint32_t i = 0; i < layout.chunks.size(); ++i) {
    list.assign(1, i);
    for_each_slot(layout, layout.chunks[i], [&](std::uint32_t s) {
      const auto chunks = neighbours.at[s];
      list.insert(list.end(), chunks.begin(), chunks.end());
    });
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    neighbours.of.push_back(list);
  }
  return neighbours;
}

std::size_t SimdLayout::bytes() const {
  return bytes_of(chunks) + bytes_of(runs) + bytes_of(batch_chunks) + bytes_of(batch_singles) +
         bytes_of(seams) + bytes_of(seams_at) + bytes_of(a) + bytes_of(b) +
         bytes_of(constraint_at) + bytes_of(rest_length) + bytes_of(inverse_square) +
         bytes_of(share_a) + bytes_of(share_b) + bytes_of(compliance) + bytes_of(inverse_mass);
}

const SimdLayout& Model::simd() const {
  return simd_.get([this] { return make_simd_layout(*this); });
}

const ChunkNeighbours& Model::chunk_neighbours() const {
  return chunk_neighbours_.get([this] { return find_chunk_neighbours(simd()); });
}

}  // namespace weft
