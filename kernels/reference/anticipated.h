/// Anticipation (paper 4.2): errors are computed when directions are renewed and then kept up to
/// date by every correction, so that visiting a constraint means comparing one number. With kSkip
/// satisfied constraints are passed over, a block at a time (paper 4.3).
///
/// Constraint c moves its end p by d = -sigma_c w_p lambda n_c (sigma = +1 at a, -1 at b), so each
/// constraint j that shares p changes by
///
///     e_j += sigma_j n_j . d = -s w_p (n_j . n_c) lambda,     s = sigma_j sigma_c
///
/// (The paper prints e_j + n_j . n_i e_i, which lacks s and w_p / (w_a + w_b).) For plain
/// constraints s w_p (n_j . n_c) is computed once, when c is first corrected along its present
/// direction. The others (hubs, ropes, contacts) are few: their products are formed on the spot. At
/// a hub no product is formed: its motion is kept, and its constraints add n . (motion) to their
/// own error when visited.
///
/// Skipping. Constraints stand colour by colour, so those of a block (at most kBlock of one colour)
/// do not touch each other: which of them are out of tolerance is decided for the whole block at
/// once, as one bit each, and then only the set bits are visited. One flag per block says that an
/// error in it may have changed since; a visit that corrected anything flags, once, the blocks that
/// share a particle with this one. A flag per constraint, kept by every push as the paper does, was
/// slower: 4.8 ns per constraint and iteration, 3.9 if a push sets it without comparing,
/// against 2.8 without any (hang, 20 x 20, 0.001 %, where half of all visits correct).
///
/// A spring's own correction lambda changes its error by softness lambda as well, and no other
/// error.
///
/// Positions stay as they are until the next renewal; impulses wait in `pending` (paper: p').
#pragma once

#include <algorithm>
#include <bit>

#include "kernels/reference/workspace.h"

namespace weft::reference {

/// kContacts: whether there are any; asking at every correction costs a twentieth.
template <bool kSkip, Directions kDirections, bool kContacts>
class AnticipatedLoop {
 public:
  AnticipatedLoop(const Relaxation& r, const Topology& t, const ContactLists& contacts,
                  const Workspace& w)
      : r_(r), t_(t), contacts_(contacts), w_(w) {
    std::fill_n(w_.pending, r_.count, 0.0);
    if constexpr (kSkip) std::fill_n(w_.moved, r_.particles, Flag::set);
  }

  /// Moves x by what is pending, then takes new directions and errors; with kSkip only where an end
  /// has moved: elsewhere they would come out the same, bit for bit.
  void renew() {
    apply_pending();
    for (const std::uint32_t hub : w_.hubs) w_.hub_motion.set(hub, {0, 0, 0});
    for (std::size_t c = 0; c < r_.count; ++c) {
      if (kSkip && !is_set(w_.moved[r_.a[c]]) && !is_set(w_.moved[r_.b[c]])) continue;
      w_.error[c] = kDirections == Directions::constant ? error(r_, c) : renew_direction(r_, c);
      remind(c);
    }
    if constexpr (kSkip) std::fill_n(w_.moved, r_.particles, Flag::clear);
    if constexpr (kDirections != Directions::each) {
      std::fill_n(w_.row_ready, r_.plain, Flag::clear);
    }
  }

  Sweep sweep() {
    Sweep sweep;
    for (std::size_t block = 0; block < t_.blocks; ++block) sweep_block(block, sweep);
    for (std::size_t c = r_.plain; c < r_.count; ++c) sweep.corrections += visit_general(c);
    sweep.visits += static_cast<std::int64_t>(r_.count - r_.plain);
    return sweep;
  }

  void finish() { apply_pending(); }

 private:
  void sweep_block(std::size_t block, Sweep& sweep) {
    if constexpr (kSkip) {
      if (!is_set(w_.changed[block])) return;
      w_.changed[block] = Flag::clear;
    }
    const std::size_t first = t_.block_first[block], last = t_.block_first[block + 1];
    std::uint64_t unsatisfied = compare(first, last);
    sweep.visits += static_cast<std::int64_t>(last - first);
    if (kSkip && unsatisfied != 0) remind_neighbours(block);
    for (; unsatisfied != 0; unsatisfied &= unsatisfied - 1) {
      ++sweep.corrections;
      correct(first + static_cast<std::size_t>(std::countr_zero(unsatisfied)));
    }
  }

  /// Bit k: constraint first + k is out of tolerance.
  std::uint64_t compare(std::size_t first, std::size_t last) const {
    std::uint64_t bits = 0;
    for (std::size_t c = last; c-- > first;) {
      bits = 2 * bits + static_cast<std::uint64_t>(std::abs(w_.error[c]) > r_.tolerance[c]);
    }
    return bits;
  }

  void remind_neighbours(std::size_t block) {
    for (std::size_t k = t_.block_begin[block]; k < t_.block_begin[block + 1]; ++k) {
      w_.changed[t_.block_neighbour[k]] = Flag::set;
    }
  }

  void remind(std::size_t c) {
    if (kSkip && c < r_.plain) w_.changed[t_.block_of[c]] = Flag::set;
  }

  void correct(std::size_t c) {
    const double e = w_.error[c];
    const double change = bilateral_change(r_, c, e);
    w_.pending[c] += change;
    w_.error[c] = 0;
    if (r_.limit < kUnlimited) {
      w_.error[c] = e - change / r_.effective_mass[c];
      remind(c);
    }
    push_row(c, change);
    if constexpr (kContacts) {
      push_contacts(c, r_.a[c], -change);
      push_contacts(c, r_.b[c], change);
    }
  }

  /// If directions live for one iteration, only the constraints still to come in it are told (paper
  /// 4.2): the errors of the others will be computed anew.
  void push_row(std::size_t c, double change) {
    const std::size_t end = t_.row_begin[c + 1];
    if constexpr (kDirections == Directions::each) {
      const Vector d = change * r_.n[c];
      for (std::size_t k = t_.row_later[c]; k < end; ++k) {
        const std::size_t j = t_.row_constraint[k];
        w_.error[j] -= t_.row_weight[k] * dot(r_.n[j], d);
      }
    } else {
      if (!is_set(w_.row_ready[c])) build_row(c);
      push_products(t_.row_begin[c], end, change);
    }
  }

  /// Two at a time: loop control would be a third of the work (8 to 10 % of a whole run).
  void push_products(std::size_t k, std::size_t end, double change) {
    double* const error = w_.error;
    const double* const product = w_.row_product;
    const std::uint32_t* const neighbour = t_.row_constraint;
    for (; k + 1 < end; k += 2) {
      error[neighbour[k]] -= product[k] * change;
      error[neighbour[k + 1]] -= product[k + 1] * change;
    }
    if (k < end) error[neighbour[k]] -= product[k] * change;
  }

  void build_row(std::size_t c) {
    const Vector n = r_.n[c];
    const std::size_t end = t_.row_begin[c + 1];
    for (std::size_t k = t_.row_begin[c]; k < end; ++k) {
      w_.row_product[k] = t_.row_weight[k] * dot(n, r_.n[t_.row_constraint[k]]);
    }
    w_.row_ready[c] = Flag::set;
  }

  /// Hubs, ropes and contacts: the error is what was anticipated plus what the hubs did since.
  bool visit_general(std::size_t c) {
    const std::size_t a = r_.a[c], b = r_.b[c];
    double e = w_.error[c];
    if (t_.hub[a]) e += dot(r_.n[c], w_.hub_motion[a]);
    if (t_.hub[b]) e -= dot(r_.n[c], w_.hub_motion[b]);
    const double change = impulse_change(r_, c, e, r_.impulse[c] + w_.pending[c]);
    if (change == 0) return false;
    w_.pending[c] += change;
    move_end(c, a, -change);
    move_end(c, b, change);
    if (r_.softness != nullptr) w_.error[c] -= r_.softness[c] * change;
    return true;
  }

  /// Moves end p of c by w_p `impulse` n_c and tells c itself and all that share p.
  void move_end(std::size_t c, std::size_t p, double impulse) {
    const Vector d = (r_.inverse_mass[p] * impulse) * r_.n[c];
    if (t_.hub[p]) {
      w_.hub_motion.add(p, d);
      return;
    }
    for (std::size_t k = t_.adjacent_begin[p]; k < t_.adjacent_begin[p + 1]; ++k) {
      push(t_.adjacent_constraint[k], p, d);
    }
    if constexpr (kContacts) push_contacts(c, p, impulse);
  }

  void push_contacts(std::size_t c, std::size_t p, double impulse) {
    if (contacts_.first[p] == kNoContact) return;
    const Vector d = (r_.inverse_mass[p] * impulse) * r_.n[c];
    for (auto k = contacts_.first[p]; k != kNoContact; k = contacts_.next[k]) {
      push(r_.pulling + k, p, d);
    }
  }

  void push(std::size_t j, std::size_t p, Vector d) {
    const double change = dot(r_.n[j], d);
    w_.error[j] += r_.a[j] == p ? change : -change;
    remind(j);
  }

  /// x' = x - sigma w lambda n for every impulse that has waited (paper 4.2, end).
  void apply_pending() {
    for (std::size_t c = 0; c < r_.count; ++c) {
      if (w_.pending[c] == 0) continue;
      apply(r_, c, w_.pending[c]);
      if (c >= r_.bilateral || r_.softness != nullptr) r_.impulse[c] += w_.pending[c];
      w_.pending[c] = 0;
      if constexpr (kSkip) w_.moved[r_.a[c]] = w_.moved[r_.b[c]] = Flag::set;
    }
  }

  const Relaxation& r_;
  const Topology& t_;
  const ContactLists& contacts_;
  const Workspace& w_;
};

}  // namespace weft::reference
