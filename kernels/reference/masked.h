/// Skipping without anticipation (paper 4.3): 64 bits per particle remember which of its
/// constraints were found satisfied since either end last moved.
///
/// The bit of a constraint is its colour: a particle has at most one constraint of each colour, so
/// the bit is unique at both ends. There are no more than 64 (engine/ordering/tiled_links.cpp);
/// constraints at hubs, ropes and contacts have no bit and are always visited.
///
///   visit c          iff bit c is set in mask[a] or mask[b]
///   c satisfied      clear its bit in both
///   c corrected      set all bits but its own in both (its own too if an impulse limit left error)
///
/// When directions are renewed, the particles that moved since the last renewal get all bits set,
/// and only constraints with a bit set are renewed: the others have the direction they would get.
/// Hence the positions are bit for bit those of OriginalLoop.
#pragma once

#include <algorithm>

#include "kernels/reference/workspace.h"

namespace weft::reference {

template <Directions kDirections>
class MaskedLoop {
 public:
  MaskedLoop(const Relaxation& r, const Topology& t, const Workspace& w)
      : r_(r), colour_(t.colour), mask_(w.mask), moved_(w.moved) {
    std::fill_n(moved_, r_.particles, Flag::set);
  }

  void renew() {
    for (std::size_t p = 0; p < r_.particles; ++p) {
      if (is_set(moved_[p])) mask_[p] = ~std::uint64_t{0};
      moved_[p] = Flag::clear;
    }
    if constexpr (kDirections == Directions::constant) return;
    for (std::size_t c = 0; c < r_.plain; ++c) {
      if (marks(c) & bit(c)) renew_direction(r_, c);
    }
    for (std::size_t c = r_.plain; c < r_.count; ++c) renew_direction(r_, c);
  }

  Sweep sweep() {
    Sweep sweep;
    for (std::size_t c = 0; c < r_.plain; ++c) {
      if (!(marks(c) & bit(c))) continue;
      ++sweep.visits;
      sweep.corrections += visit_plain(c);
    }
    for (std::size_t c = r_.plain; c < r_.count; ++c) sweep.corrections += visit_unmasked(c);
    sweep.visits += static_cast<std::int64_t>(r_.count - r_.plain);
    return sweep;
  }

  void finish() {}

 private:
  std::uint64_t bit(std::size_t c) const { return std::uint64_t{1} << colour_[c]; }
  std::uint64_t marks(std::size_t c) const { return mask_[r_.a[c]] | mask_[r_.b[c]]; }

  bool visit_plain(std::size_t c) {
    const std::size_t a = r_.a[c], b = r_.b[c];
    const double change = impulse_change(r_, c, error(r_, c), 0);
    if (change == 0) {
      mask_[a] &= ~bit(c);
      mask_[b] &= ~bit(c);
      return false;
    }
    accumulate(r_, c, change);
    apply(r_, c, change);
    const std::uint64_t others = r_.limit < kUnlimited ? ~std::uint64_t{0} : ~bit(c);
    mark_moved(a, others);
    mark_moved(b, others);
    return true;
  }

  bool visit_unmasked(std::size_t c) {
    const double change = impulse_change(r_, c, error(r_, c), r_.impulse[c]);
    if (change == 0) return false;
    r_.impulse[c] += change;
    apply(r_, c, change);
    mark_moved(r_.a[c], ~std::uint64_t{0});
    mark_moved(r_.b[c], ~std::uint64_t{0});
    return true;
  }

  void mark_moved(std::size_t p, std::uint64_t bits) {
    mask_[p] = bits;
    moved_[p] = Flag::set;
  }

  const Relaxation& r_;
  const std::uint8_t* colour_;
  std::uint64_t* mask_;
  Flag* moved_;
};

}  // namespace weft::reference
