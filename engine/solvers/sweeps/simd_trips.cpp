/// Many passes, with one meeting for all of them and several to a trip through memory.
///
/// What a share needs of a pass is the seam with the share before it, and what its own seam with
/// the share behind it needs is that one's first tile (Team's rounds, a pass each):
///
///     share 0:  | tile 0 | tile 1 | seam | tile 0 | tile 1 | seam | ...
///     share 1:   | tile 2 | tile 3 |     . | tile 2 | tile 3 |    . | ...
///
/// kDepth passes make a trip. In the first of them a tile gets the next ones too, while it is in
/// the caches, as soon as its neighbours have had the ones before:
///
///     pass 0:  | tile 0 | tile 1 | tile 2 |        | tile 3 |        | tile 4 |        |
///     pass 1:                             | tile 1 |        | tile 2 |        | tile 3 |
///
/// In pass p the first p tiles of a share and its last p, with their seams, are left to the pass's
/// own round: what they need comes from the shares beside it. Every constraint meets the same
/// displacements as in passes one by one: the bits are the same.
#include <algorithm>

#include "engine/solvers/sweeps/simd_loop.h"

namespace weft {
namespace {

constexpr int kDepth = 2;
static_assert(Team::kMostRounds % kDepth == 0);  // only the last trip of all may be shorter

}  // namespace

/// What is between tiles joins each to the next one only, and no pass decides about the next.
bool SimdLoop::meets_neighbours_only() const {
  const Ordering& ordering = s_.model_.ordering;
  return !ordering.tiles.empty() && layout_.seams_join_neighbours &&
         ordering.batches.size() <= ordering.between_tiles + 1 &&
         layout_.hub_first == layout_.hub_last && s_.contacts_.spheres.empty() && !skips() &&
         !(anticipates() && layout_.has_ropes);
}

kernels::Sweep SimdLoop::sweeps(int passes) {
  kernels::Sweep sum;
  if (!meets_neighbours_only()) {
    for (int i = 0; i < passes; ++i) sum += sweep();
    return sum;
  }
  for (int done = 0; done < passes; done += Team::kMostRounds) {
    const int rounds = std::min(passes - done, Team::kMostRounds);
    clear_sweeps();
    auto work = [&](const Team::Part& part, std::size_t first, std::size_t last) {
      do_part(part, rounds, {first, last});
    };
    team_.for_each_share_in_rounds(s_.model_.ordering.tiles.size(), rounds, work);
    sum += sum_of_sweeps();
  }
  return sum;
}

void SimdLoop::do_part(const Team::Part& part, int rounds, const Share& share) {
  const int pass = part.round % kDepth, left = rounds - (part.round - pass);
  kernels::Sweep& sum = s_.sweeps_[share.first];
  switch (part.stage) {
    case Team::Stage::front:
      sum += sweep_with_seams(share.first, share.first);
      break;
    case Team::Stage::rest:
      sum += pass == 0 ? sweep_trip(share, static_cast<std::size_t>(std::min(kDepth, left)))
                       : sweep_ends(share, static_cast<std::size_t>(pass));
      break;
    case Team::Stage::close:
      sum += sweep_seams(share.last, share.first, share.last - 1);
      break;
  }
}

/// A tile, and then its seams with those before it, as far as tile `from`.
kernels::Sweep SimdLoop::sweep_with_seams(std::size_t tile, std::size_t from) {
  kernels::Sweep sweep = sweep_tile(s_.model_.ordering.tiles[tile]);
  sweep += sweep_seams(tile, from, tile);
  return sweep;
}

/// All of pass 0 but the first tile, and of pass p the tiles first + p ... last - p - 1.
kernels::Sweep SimdLoop::sweep_trip(const Share& share, std::size_t depth) {
  kernels::Sweep sweep;
  for (std::size_t i = share.first + 1; i < share.last; ++i) {
    for (std::size_t pass = 0; pass < depth && i >= share.first + 2 * pass; ++pass) {
      const bool alone = i == share.first + 2 * pass;  // the tile before it comes later
      sweep += sweep_with_seams(i - pass, alone ? i - pass : share.first);
    }
  }
  return sweep;
}

/// What the trip has left of a pass, but the first tile.
kernels::Sweep SimdLoop::sweep_ends(const Share& share, std::size_t pass) {
  kernels::Sweep sweep;
  const bool all = share.last - share.first <= 2 * pass;
  const std::size_t begin = all ? share.last : share.first + pass;  // of what the trip has done
  const std::size_t end = all ? share.last : share.last - pass;
  for (std::size_t tile = share.first + 1; tile < begin; ++tile) {
    sweep += sweep_with_seams(tile, share.first);
  }
  if (!all) sweep += sweep_seams(begin, share.first, begin - 1);
  for (std::size_t tile = end; tile < share.last; ++tile) {
    sweep += sweep_with_seams(tile, share.first);
  }
  return sweep;
}

}  // namespace weft
