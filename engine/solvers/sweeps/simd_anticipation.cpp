/// Settings::anticipate_products: the loop in the form of paper 4.2 (kernels/simd/anticipate.h).
///
/// Distance constraints of the batches keep their errors, and pull what their neighbours changed
/// through the products of directions. Their impulses become displacements, u, at the renewal of
/// directions. Ropes, constraints at hubs and contacts work by displacements, where there are any,
/// so that then a pass has more parts:
///
///     distance constraints      by what they pull
///     their sums                become displacements
///     ropes, hubs, contacts     by displacements
///
/// If the last corrected something, all errors of distance constraints are formed from
/// displacements, and nothing is left to pull. (The reference, kernels/reference/anticipated.h,
/// forms the products of these few on the spot.)
///
/// A constraint pulls the last change of each neighbour: between two of its visits each must have
/// had one, which is so in trips (simd_trips.cpp) too, or have been passed over. Skipping sees to
/// the rest: a chunk is passed over only if neither it nor a neighbour has changed anything since
/// its last visit, so that all changes in question are 0.
#include <algorithm>

#include "engine/solvers/sweeps/pull_layout.h"
#include "engine/solvers/sweeps/simd_loop.h"

namespace weft {

bool SimdLoop::has_others() const {
  return layout_.has_ropes || layout_.hub_first < layout_.hub_last || !s_.contacts_.spheres.empty();
}

bool SimdLoop::has_turn(const Batch& batch) const {
  return turn_ == Turn::all || (batch.kind == ConstraintKind::rope) == (turn_ == Turn::ropes);
}

kernels::Sweep SimdLoop::sweep_in_turn(Turn turn) {
  turn_ = turn;
  const kernels::Sweep sweep = sweep_batches();
  turn_ = Turn::products;
  return sweep;
}

kernels::Sweep SimdLoop::sweep_others() {
  apply_sums();
  kernels::Sweep sweep;
  if (layout_.has_ropes) sweep += sweep_in_turn(Turn::ropes);
  sweep_hubs(sweep);
  sweep_contacts(sweep);
  if (sweep.corrections > 0) refresh_errors();
  return sweep;
}

void SimdLoop::relax_anticipated(std::size_t first, std::size_t last, kernels::Sweep& sweep) {
  const PullLayout& pulls = s_.model_.pulls();
  for (std::size_t i = first; i < last; ++i) {
    if (!wanted(i)) continue;
    const Chunk& chunk = layout_.chunks[i];
    std::uint32_t corrections = 0;
    const auto relax = [&](std::uint32_t begin, std::uint32_t end, bool scattered) {
      corrections += scattered ? table_.relax_anticipated_singles(p_, begin, end)
                               : table_.relax_anticipated_run(p_, {0, 0, begin, end - begin});
    };
    const std::uint32_t c = chunk.run.constraint;
    pulls.for_each_stretch(c, c + chunk.run.length, relax);
    s_.corrections_[i] = corrections;
    sweep.visits += chunk.real;
  }
}

/// In the order of a pass, so that what a slot gets is summed up in one order.
void SimdLoop::apply_sums() { sweep_in_turn(Turn::sums); }

/// Only what was corrected since directions were renewed has a sum.
void SimdLoop::apply_sums(std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    if (marks() && !s_.stale_[i]) continue;
    const Chunk& chunk = layout_.chunks[i];
    const std::uint32_t c = chunk.run.constraint;
    if (chunk.singles) {
      table_.apply_sums_singles(p_, r_, c, c + chunk.run.length);
    } else {
      table_.apply_sums_run(p_, r_, chunk.run);
    }
  }
}

/// A constraint that has not moved since directions were renewed has the error that it had then.
/// Rounding may have brought some of the others out of tolerance.
void SimdLoop::refresh_errors() {
  team_.for_each_part(layout_.chunks.size(), kPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Chunk& chunk = layout_.chunks[i];
      if (chunk.rope || (marks() && !s_.stale_[i])) continue;
      const std::uint32_t c = chunk.run.constraint;
      if (chunk.singles) {
        table_.refresh_errors_singles(p_, r_, c, c + chunk.run.length);
      } else {
        table_.refresh_errors_run(p_, r_, chunk.run);
      }
      if (marks()) s_.changed_[i] = 1;
    }
  });
}

/// With skipping, only where a direction is new, of the constraint itself or of a neighbour: there
/// the chunk of either counts as changed.
void SimdLoop::renew_products() {
  team_.for_each_part(layout_.chunks.size(), kPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto is_new = [&](std::uint32_t chunk) { return s_.changed_[chunk] != 0; };
      if (layout_.chunks[i].rope) continue;
      if (!marks() || std::ranges::any_of(neighbours_.of[i], is_new)) renew_products(i);
    }
  });
}

void SimdLoop::renew_products(std::size_t i) {
  const std::uint32_t c = layout_.chunks[i].run.constraint;
  const auto renew = [&](std::uint32_t begin, std::uint32_t end, bool scattered) {
    if (scattered) {
      table_.renew_products_singles(p_, r_, begin, end);
    } else {
      table_.renew_products_run(p_, r_, {0, 0, begin, end - begin});
    }
  };
  s_.model_.pulls().for_each_stretch(c, c + layout_.chunks[i].run.length, renew);
}

}  // namespace weft
