#include "engine/solvers/small_steps/simd_links.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"

namespace weft {

SimdLinks::SimdLinks(const Model& model, const Settings& settings, const simd::Table& table)
    : has_springs_(model.constraints.has_springs()),
      layout_(model.small_steps()),
      tolerance_(tuning::kLocalShare * settings.tolerance),
      table_(table),
      spans_(layout_.blocks.size()),
      base_step_(layout_.yarns.rows()),
      edges_out_(layout_.blocks.size()),
      yarns_out_(layout_.yarns.rows()),
      multiplier_(layout_.multipliers()) {
  const std::size_t wanted =
      settings.threads > 0 ? static_cast<std::size_t>(settings.threads) : kMostYarnShares;
  if (layout_.has_yarns())
    scratch_.resize(layout_.yarns.scratch_rows() * std::min(wanted, kMostYarnShares));
}

float SimdLinks::squared_tolerance() const { return squared(tolerance_); }

void SimdLinks::measure_base(const float* base, Team& team) {
  is_base_new_ = true;
  team.for_each_share(layout_.blocks.size(), [&](std::size_t first, std::size_t last) {
    table_.measure_edges(layout_.blocks.data(), spans_.data(), base, first, last);
  });
}

simd::Yarns SimdLinks::yarns(float* base) {
  const YarnLayout& yarns = layout_.yarns;
  return {.kind = yarns.kind.data(),
          .kinds = yarns.kinds.data(),
          .slot = yarns.slot.data(),
          .patch = yarns.patches.data(),
          .base = base,
          .base_step = base_step_.data(),
          .cell = static_cast<float>(layout_.cell),
          .moved = is_base_new_,
          .from_memory = yarns.from_memory()};
}

simd::YarnRelaxation SimdLinks::of_yarns(const LinkSweep& sweep) {
  return {static_cast<float>(sweep.omega), squared_tolerance(), yarns_out_.data(),
          squared(sweep.left)};
}

simd::EdgeRelaxation SimdLinks::of_edges(const LinkSweep& sweep) {
  return {sweep.u,
          layout_.blocks.data(),
          spans_.data(),
          edges_out_.data(),
          static_cast<float>(sweep.omega),
          squared_tolerance(),
          squared(sweep.left)};
}

simd::SpringLaws SimdLinks::laws(const LinkSweep& sweep) const {
  return {.u_start = sweep.u_start,
          .scale = static_cast<float>(sweep.laws.springs.scale),
          .damping = static_cast<float>(sweep.laws.springs.damping),
          .most_compliance = static_cast<float>(
              std::min<double>(sweep.laws.softest, std::numeric_limits<float>::max())),
          .strain = static_cast<float>(tolerance_),
          .continues = sweep.continues};
}

simd::SpringRelaxation SimdLinks::of_springs(const LinkSweep& sweep) {
  return {of_edges(sweep), layout_.springs.data(), multiplier_.data(), laws(sweep)};
}

simd::YarnSpringRelaxation SimdLinks::of_spring_yarns(const LinkSweep& sweep) {
  return {of_yarns(sweep), multiplier_.data() + layout_.first_multiplier_of_yarns(),
          static_cast<float>(layout_.yarns.lightest), laws(sweep)};
}

/// work(block, scratch), for blocks first ... last - 1, which share no particle or are only read.
template <class Work>
void SimdLinks::for_each_block(Team& team, std::size_t first, std::size_t last, Work&& work) {
  const std::size_t rows = layout_.yarns.scratch_rows(), count = last - first;
  const std::size_t shares = std::min({scratch_.size() / rows, count, team.size()});
  team.for_each(shares, [&](std::size_t share) {
    const std::size_t end = first + count * (share + 1) / shares;
    for (std::size_t i = first + count * share / shares; i < end; ++i) {
      work(layout_.yarns.blocks[i], scratch_.data() + rows * share);
    }
  });
}

void SimdLinks::sweep_family(std::size_t family, const LinkSweep& sweep, Team& team) {
  const simd::Yarns yarns = this->yarns(sweep.base);
  const simd::YarnRelaxation rigid = of_yarns(sweep);
  const simd::YarnSpringRelaxation springs = of_spring_yarns(sweep);
  const std::vector<std::uint32_t>& begin = layout_.yarns.family_begin;
  for_each_block(team, begin[family], begin[family + 1],
                 [&](const simd::YarnBlock& block, simd::YarnScratch* scratch) {
                   if (has_springs_)
                     table_.relax_spring_yarns(yarns, block, sweep.u, scratch, springs);
                   else
                     table_.relax_yarns(yarns, block, sweep.u, scratch, rigid);
                 });
}

/// work(batch, first, last): blocks first ... last - 1 of it.
template <class Work>
void SimdLinks::for_each_batch(Team& team, Work&& work) const {
  team.for_each(layout_.tiles.size(), [&](std::size_t tile) {
    for (std::uint32_t i = layout_.tiles[tile].first; i < layout_.tiles[tile].last; ++i) {
      work(layout_.batches[i], layout_.batches[i].first, layout_.batches[i].last);
    }
  });
  for (std::size_t i = layout_.between_tiles; i < layout_.batches.size(); ++i) {
    const EdgeBatch& batch = layout_.batches[i];
    team.for_each_share(batch.last - batch.first, [&](std::size_t first, std::size_t last) {
      work(batch, batch.first + static_cast<std::uint32_t>(first),
           batch.first + static_cast<std::uint32_t>(last));
    });
  }
}

void SimdLinks::sweep_edges(const LinkSweep& sweep, Team& team) {
  const simd::EdgeRelaxation rigid = of_edges(sweep);
  const simd::SpringRelaxation springs = of_springs(sweep);
  for_each_batch(team, [&](const EdgeBatch& batch, std::uint32_t first, std::uint32_t last) {
    if (has_springs_)
      table_.relax_springs(springs, batch.rope, first, last);
    else if (batch.rope)
      table_.relax_ropes(rigid, first, last);
    else
      table_.relax_distances(rigid, first, last);
  });
}

void SimdLinks::judge_springs(const LinkSweep& sweep, Team& team) {
  const simd::SpringRelaxation edges = of_springs(sweep);
  for_each_batch(team, [&](const EdgeBatch& batch, std::uint32_t first, std::uint32_t last) {
    table_.judge_springs(edges, batch.rope, first, last);
  });
  const simd::Yarns yarns = this->yarns(sweep.base);
  const simd::YarnSpringRelaxation links = of_spring_yarns(sweep);
  for_each_block(team, 0, layout_.yarns.blocks.size(),
                 [&](const simd::YarnBlock& block, simd::YarnScratch* scratch) {
                   table_.judge_spring_yarns(yarns, block, sweep.u, scratch, links);
                 });
}

/// Nearly all bits are 0, and without an instruction for it popcount is a call.
std::int64_t SimdLinks::count_out() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < edges_out_.size(); ++i) {
    const auto lanes = static_cast<std::uint32_t>(edges_out_[i] & layout_.used[i]);
    if (lanes != 0) count += std::popcount(lanes);
  }
  for (const std::uint32_t lanes : yarns_out_) {
    if (lanes != 0) count += std::popcount(lanes);
  }
  return count;
}

std::size_t SimdLinks::bytes() const {
  return bytes_of(spans_) + bytes_of(base_step_) + bytes_of(scratch_) + bytes_of(edges_out_) +
         bytes_of(yarns_out_) + bytes_of(multiplier_);
}

}  // namespace weft
