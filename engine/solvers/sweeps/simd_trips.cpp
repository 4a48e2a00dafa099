/// Many passes, several of them to a trip through memory.
///
/// kDepth passes make a trip. In the first of them a tile gets the next ones too, while it is in
/// the caches, as soon as its neighbours have had the ones before:
///
///     pass 0:  | tile 0 | tile 1 | tile 2 |        | tile 3 |        | tile 4 |        |
///     pass 1:                             | tile 1 |        | tile 2 |        | tile 3 |
///
/// The tiles are divided into one share per thread, the same shares in all passes of a trip. At the
/// ends of a share pass p needs the shares beside it, so the first p tiles of a share and its last
/// p, with their seams, are left to a loop of their own, which begins when all shares have ended
/// pass p - 1. Seams between shares are swept after each of these loops. Every constraint meets the
/// same displacements as in passes one by one: the bits are the same.
#include <algorithm>

#include "engine/solvers/sweeps/simd_loop.h"

namespace weft {
namespace {

constexpr int kDepth = 2;

}  // namespace

/// Constraints between tiles join each to the next one only, and no pass decides about the next.
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
  for (int done = 0; done < passes; done += kDepth) {
    sweep_trip(static_cast<std::size_t>(std::min(kDepth, passes - done)), sum);
  }
  return sum;
}

void SimdLoop::sweep_trip(std::size_t depth, kernels::Sweep& sum) {
  const std::size_t tiles = s_.model_.ordering.tiles.size(), shares = std::min(tiles, team_.size());
  for (std::size_t pass = 0; pass < depth; ++pass) {
    clear_sweeps();
    team_.for_each(shares, [&](std::size_t i) {
      const Share share{tiles * i / shares, tiles * (i + 1) / shares};
      kernels::Sweep sweep = sweep_with_seams(share.first, share.first);
      sweep += pass == 0 ? sweep_ahead(share, depth) : sweep_ends(share, pass);
      s_.sweeps_[share.first] = {sweep};
      for (std::size_t tile = share.first; tile < share.last; ++tile) leave_open(tile, share.first);
    });
    sum += sum_of_sweeps();
    sweep_open_seams(sum);
  }
}

/// A tile, and then its seams with those before it, as far as tile `from`.
kernels::Sweep SimdLoop::sweep_with_seams(std::size_t tile, std::size_t from) {
  kernels::Sweep sweep = sweep_tile(s_.model_.ordering.tiles[tile]);
  sweep += sweep_seams(tile, from, tile);
  return sweep;
}

/// All of pass 0 but the first tile, and of pass p the tiles first + p ... last - p - 1.
kernels::Sweep SimdLoop::sweep_ahead(const Share& share, std::size_t depth) {
  kernels::Sweep sweep;
  for (std::size_t i = share.first + 1; i < share.last; ++i) {
    for (std::size_t pass = 0; pass < depth && i >= share.first + 2 * pass; ++pass) {
      const bool alone = i == share.first + 2 * pass;  // the tile before it comes later
      sweep += sweep_with_seams(i - pass, alone ? i - pass : share.first);
    }
  }
  return sweep;
}

/// The part of a pass that sweep_ahead has left, but the first tile.
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
