#include "engine/solvers/sweeps/simd_loop.h"

#include <algorithm>
#include <atomic>

#include "engine/solvers/sweeps/pull_layout.h"

namespace weft {

SimdLoop::SimdLoop(SimdSystem& system, const Unknowns& unknowns, Team& team)
    : SimdLoop(system, unknowns.velocities() ? system.velocities_ : system.positions_, unknowns,
               team) {}

SimdLoop::SimdLoop(SimdSystem& system, ScaledConstraints& constraints, const Unknowns& unknowns,
                   Team& team)
    : s_(system),
      layout_(system.layout_),
      neighbours_(system.neighbours_),
      table_(system.table_),
      unknowns_(unknowns),
      r_(system.relaxation(constraints)),
      contacts_(r_),
      g_(system.geometry(unknowns.x, constraints)),
      contact_geometry_(g_),
      team_(team) {
  ContactLanes& c = s_.contacts_;
  contacts_.blocks = c.blocks.data();
  contacts_.impulse = c.impulse.data();
  contacts_.a = contact_geometry_.a = c.a.data();
  contacts_.b = contact_geometry_.b = c.b.data();
  contact_geometry_.rest_length = c.distance.data();
  contact_geometry_.scale = c.scale.data();
  std::ranges::fill(s_.u_, 0.f);
  if (!anticipates()) return;
  p_ = s_.pulls_->view(s_.model_.pulls(), constraints.weight, r_.threshold);
  turn_ = Turn::products;
}

void SimdLoop::apply_displacements() {
  const kernels::VectorsView target = unknowns_.velocities() ? unknowns_.v : unknowns_.x;
  team_.for_each_part(layout_.slots, kStretch, [&](std::size_t first, std::size_t last) {
    table_.apply_displacements(target, r_.u, first, last);
  });
}

/// With skipping, only where something moved since the last renewal: elsewhere directions and
/// errors would come out the same.
void SimdLoop::renew() {
  if (anticipates() && renewed_) apply_sums();
  renewed_ = true;
  apply_displacements();
  if (has_springs()) s_.renew_multipliers();
  team_.for_each_part(layout_.chunks.size(), kPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (marks() && !s_.stale_[i]) continue;
      renew_chunk(i);
      if (!marks()) continue;
      s_.stale_[i] = 0;
      s_.changed_[i] = 1;
    }
  });
  renew_rest();
  if (anticipates()) renew_products();
  if (masks()) std::ranges::fill(s_.mask_, ~std::uint64_t{0});
}

void SimdLoop::finish() {
  if (anticipates()) apply_sums();
  apply_displacements();
}

void SimdLoop::renew_chunk(std::size_t i) {
  const Chunk& chunk = layout_.chunks[i];
  const std::uint32_t first = chunk.run.constraint, last = first + chunk.run.length;
  if (chunk.singles) {
    renew_singles(first, last);
  } else {
    renew_run(chunk.run);
  }
}

void SimdLoop::renew_run(const kernels::Run& run) {
  if (unknowns_.velocities()) return table_.renew_velocity_run(g_, unknowns_.v, r_, run);
  if (unknowns_.start.x == nullptr) return table_.renew_run(g_, r_, run);
  table_.renew_from_start_run(g_, unknowns_.start, r_, run);
}

void SimdLoop::renew_singles(std::uint32_t first, std::uint32_t last) {
  if (unknowns_.velocities())
    return table_.renew_velocity_singles(g_, unknowns_.v, r_, first, last);
  if (unknowns_.start.x == nullptr) return table_.renew_singles(g_, r_, first, last);
  table_.renew_from_start_singles(g_, unknowns_.start, r_, first, last);
}

/// Hubs and contacts. These come about within a step: they act along their directions at x.
void SimdLoop::renew_rest() {
  if (layout_.hub_first < layout_.hub_last) {
    renew_singles(layout_.hub_first, static_cast<std::uint32_t>(layout_.constraint_slots));
  }
  for (const auto& [first, last, real] : s_.contacts_.spheres) {
    if (unknowns_.velocities()) {
      table_.renew_velocity_singles(contact_geometry_, unknowns_.v, contacts_, first, last);
    } else {
      table_.renew_singles(contact_geometry_, contacts_, first, last);
    }
  }
}

kernels::Sweep SimdLoop::sweep() {
  kernels::Sweep sweep = sweep_batches();
  if (!anticipates()) {
    sweep_hubs(sweep);
    sweep_contacts(sweep);
  } else if (has_others()) {
    sweep += sweep_others();
  }
  if (skips()) choose_density(sweep);
  return sweep;
}

kernels::Sweep SimdLoop::sweep_batches() {
  const Ordering& ordering = s_.model_.ordering;
  clear_sweeps();
  team_.for_each_share(ordering.tiles.size(), [&](std::size_t first, std::size_t last) {
    sweep_share({first, last});
  });
  kernels::Sweep sweep = sum_of_sweeps();
  sweep_open_seams(sweep);
  const std::size_t done = layout_.seams.empty() ? 0 : 1;
  for (std::size_t i = ordering.between_tiles + done; i < ordering.batches.size(); ++i) {
    sweep += sweep_batch_between_tiles(i);
  }
  return sweep;
}

void SimdLoop::clear_sweeps() {
  for (std::size_t i = 0; i < s_.model_.ordering.tiles.size(); ++i) s_.sweeps_[i] = {};
}

kernels::Sweep SimdLoop::sum_of_sweeps() const {
  kernels::Sweep sum;
  for (std::size_t i = 0; i < s_.model_.ordering.tiles.size(); ++i) sum += s_.sweeps_[i];
  return sum;
}

/// With the seams that they have within their share; the others are left open.
void SimdLoop::sweep_share(const Share& share) {
  kernels::Sweep sweep;
  for (std::size_t i = share.first; i < share.last; ++i) {
    sweep += sweep_tile(s_.model_.ordering.tiles[i]);
    sweep += sweep_seams(i, share.first, i);
    leave_open(i, share.first);
  }
  s_.sweeps_[share.first] = {sweep};
}

/// Leaving the dense state everything counts as changed: the next pass finds out what did.
void SimdLoop::choose_density(const kernels::Sweep& sweep) {
  constexpr std::int64_t kDenseShare = 16;
  const auto constraints = static_cast<std::int64_t>(s_.model_.constraints.size());
  const bool dense = kDenseShare * sweep.corrections > constraints;
  if (dense_ && !dense) {
    std::ranges::fill(s_.changed_, std::uint8_t{1});
    std::ranges::fill(s_.stale_, std::uint8_t{1});
  }
  dense_ = dense;
}

kernels::Sweep SimdLoop::sweep_tile(const Tile& tile) {
  kernels::Sweep sweep;
  for (std::size_t batch = tile.first_batch; batch < tile.last_batch; ++batch) {
    sweep += sweep_chunks(batch, layout_.batch_chunks[batch], layout_.batch_chunks[batch + 1]);
  }
  return sweep;
}

/// The first batch between tiles need not wait for all of them: what joins a tile to others of the
/// same share is done as soon as it is, while both are in the caches, and no thread waits for it.
/// Those of the seams at a tile that begin at tiles from ... to.
kernels::Sweep SimdLoop::sweep_seams(std::size_t tile, std::size_t from, std::size_t to) {
  kernels::Sweep sweep;
  const std::size_t batch = s_.model_.ordering.between_tiles;
  for (std::size_t i = layout_.seams_at[tile]; i < layout_.seams_at[tile + 1]; ++i) {
    const TileSeam& seam = layout_.seams[i];
    if (seam.first_tile < from || seam.first_tile > to) continue;
    sweep += sweep_chunks(batch, seam.first_chunk, seam.last_chunk);
  }
  return sweep;
}

/// Notes which seams at a tile of a share begin before it. The flags are in one line for all.
void SimdLoop::leave_open(std::size_t tile, std::size_t first_tile) {
  for (std::size_t i = layout_.seams_at[tile]; i < layout_.seams_at[tile + 1]; ++i) {
    const bool open = layout_.seams[i].first_tile < first_tile;
    if (s_.open_seam_[i] != open) s_.open_seam_[i] = open;
  }
}

/// Between shares: as a rule few.
void SimdLoop::sweep_open_seams(kernels::Sweep& sweep) {
  const std::size_t batch = s_.model_.ordering.between_tiles, count = layout_.seams.size();
  std::size_t open_chunks = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const TileSeam& seam = layout_.seams[i];
    if (s_.open_seam_[i]) open_chunks += seam.last_chunk - seam.first_chunk;
  }
  const auto sweep_seam = [&](std::size_t i) {
    const TileSeam& seam = layout_.seams[i];
    s_.sweeps_[i] = {s_.open_seam_[i] ? sweep_chunks(batch, seam.first_chunk, seam.last_chunk)
                                      : kernels::Sweep{}};
  };
  if (open_chunks > kPiece) {
    team_.for_each(count, sweep_seam);
  } else {
    for (std::size_t i = 0; i < count; ++i) sweep_seam(i);
  }
  for (std::size_t i = 0; i < count; ++i) sweep += s_.sweeps_[i];
}

kernels::Sweep SimdLoop::sweep_batch_between_tiles(std::size_t batch) {
  const std::size_t first = layout_.batch_chunks[batch], last = layout_.batch_chunks[batch + 1];
  const std::size_t pieces = (last - first + kPiece - 1) / kPiece;
  team_.for_each(pieces, [&](std::size_t piece) {
    const std::size_t begin = first + piece * kPiece;
    s_.sweeps_[piece] = {sweep_chunks(batch, begin, std::min(last, begin + kPiece))};
  });
  kernels::Sweep sweep;
  for (std::size_t piece = 0; piece < pieces; ++piece) sweep += s_.sweeps_[piece];
  return sweep;
}

/// Chunks of one batch touch no particle in common: they are relaxed first and looked at
/// afterwards.
kernels::Sweep SimdLoop::sweep_chunks(std::size_t index, std::size_t first, std::size_t last) {
  kernels::Sweep sweep;
  if (!has_turn(s_.model_.ordering.batches[index])) return sweep;
  if (turn_ == Turn::sums) {
    apply_sums(first, last);
    return sweep;
  }
  if (turn_ == Turn::products) {
    relax_anticipated(first, last, sweep);
  } else {
    relax_chunks(index, first, last, sweep);
  }
  for (std::size_t i = first; i < last; ++i) {
    if (!wanted(i)) continue;
    sweep.corrections += s_.corrections_[i];
    if (!marks()) continue;
    s_.changed_[i] = 0;
    if (s_.corrections_[i] > 0) mark_neighbours(i);
  }
  return sweep;
}

void SimdLoop::relax_chunks(std::size_t index, std::size_t first, std::size_t last,
                            kernels::Sweep& sweep) {
  const Batch& batch = s_.model_.ordering.batches[index];
  const std::size_t singles = std::clamp<std::size_t>(layout_.batch_singles[index], first, last);
  relax_runs(batch, first, singles, sweep);
  for (std::size_t i = singles; i < last; ++i) relax_one(batch, i, sweep);
}

void SimdLoop::relax_runs(const Batch& batch, std::size_t first, std::size_t last,
                          kernels::Sweep& sweep) {
  const bool plain = batch.kind == ConstraintKind::distance && !masks() && !has_springs();
  if (!plain) {
    for (std::size_t i = first; i < last; ++i) relax_one(batch, i, sweep);
    return;
  }
  table_.relax_runs(r_, layout_.runs.data() + first, last - first,
                    marks() ? s_.changed_.data() + first : nullptr, s_.corrections_.data() + first);
  for (std::size_t i = first; i < last; ++i) {
    if (wanted(i)) sweep.visits += layout_.chunks[i].real;
  }
}

void SimdLoop::relax_one(const Batch& batch, std::size_t i, kernels::Sweep& sweep) {
  const Chunk& chunk = layout_.chunks[i];
  const std::uint32_t first = chunk.run.constraint, last = first + chunk.run.length;
  std::uint32_t& corrections = s_.corrections_[i];
  if (!wanted(i)) return;
  if (masks() && !chunk.singles && !chunk.rope) {
    std::uint64_t visits = 0;
    corrections = table_.relax_masked_run(r_, chunk.run, std::uint64_t{1} << batch.colour, visits);
    sweep.visits += std::min<std::int64_t>(static_cast<std::int64_t>(visits), chunk.real);
    return;
  }
  sweep.visits += chunk.real;
  if (has_springs()) {
    corrections = chunk.singles ? table_.relax_spring_singles(r_, first, last, chunk.rope)
                                : table_.relax_spring_run(r_, chunk.run, chunk.rope);
  } else if (chunk.singles) {
    corrections = chunk.rope ? table_.relax_rope_singles(r_, first, last)
                             : table_.relax_singles(r_, first, last);
  } else {
    corrections =
        chunk.rope ? table_.relax_rope_run(r_, chunk.run) : table_.relax_run(r_, chunk.run);
  }
  if (masks() && corrections > 0) {
    mark_slots(r_.a, first, last);
    mark_slots(r_.b, first, last);
  }
}

void SimdLoop::sweep_hubs(kernels::Sweep& sweep) {
  if (layout_.hub_first == layout_.hub_last) return;
  const std::uint32_t first = layout_.hub_first, ropes = layout_.hub_ropes, last = layout_.hub_last;
  const auto corrections = has_springs() ? table_.relax_spring_serial(r_, first, ropes, false) +
                                               table_.relax_spring_serial(r_, ropes, last, true)
                                         : table_.relax_serial(r_, first, ropes) +
                                               table_.relax_rope_serial(r_, ropes, last);
  sweep.visits += layout_.hub_last - layout_.hub_first;
  sweep.corrections += corrections;
  if (corrections == 0) return;
  mark_slots(r_.a, layout_.hub_first, layout_.hub_last);
  mark_slots(r_.b, layout_.hub_first, layout_.hub_last);
}

void SimdLoop::sweep_contacts(kernels::Sweep& sweep) {
  for (const ContactLanes::Range& range : s_.contacts_.spheres) {
    const auto corrections = table_.relax_contacts(contacts_, range.first, range.last);
    sweep.visits += range.real;
    sweep.corrections += corrections;
    if (corrections > 0) mark_slots(contacts_.b, range.first, range.last);
  }
}

/// Several threads may set the flags of a chunk between tiles, all to the same value.
void SimdLoop::mark(std::size_t chunk) {
  std::atomic_ref(s_.changed_[chunk]).store(1, std::memory_order_relaxed);
  std::atomic_ref(s_.stale_[chunk]).store(1, std::memory_order_relaxed);
}

void SimdLoop::mark_neighbours(std::size_t chunk) {
  for (const std::uint32_t i : neighbours_.of[chunk]) mark(i);
}

void SimdLoop::mark_slots(const std::uint32_t* slots, std::size_t first, std::size_t last) {
  for (std::size_t c = first; c < last; ++c) {
    if (masks()) s_.mask_[slots[c]] = ~std::uint64_t{0};
    if (!marks()) continue;
    for (const std::uint32_t i : neighbours_.at[slots[c]]) mark(i);
  }
}

}  // namespace weft
