/// Anticipation (paper 4.2): errors are computed when directions are renewed and then kept up to
/// date by every correction, so that visiting a constraint means comparing one number. With kSkip a
/// flag per constraint is kept as well (paper 4.3).
///
/// Constraint c moves its end p by d = -sigma_c w_p lambda n_c (sigma = +1 at a, -1 at b), so each
/// constraint j that shares p changes by
///
///     e_j += sigma_j n_j . d = -s w_p (n_j . n_c) lambda,     s = sigma_j sigma_c
///
/// (The paper prints e_j + n_j . n_i e_i, which lacks s and w_p / (w_a + w_b).) For plain
/// constraints s w_p (n_j . n_c) is precomputed when c is first corrected along its present
/// direction. The others (hubs, ropes, contacts) are few: their products are formed on the spot. At
/// a hub nobody is told: its motion is kept, and its constraints add n . (motion) to their own
/// error when visited.
///
/// Positions stay as they are until the next renewal; impulses wait in `pending` (paper: p').
#pragma once

#include <algorithm>
#include <cstring>

#include "kernels/reference/relax.h"

namespace weft::reference {

/// each: directions live for one iteration, so only constraints still to come in it are told (paper
/// 4.2), the errors of the others will be computed anew. frozen: many iterations, all are told.
/// constant: the same, and the directions are given (velocity loop).
template <bool kSkip, Directions kDirections>
class AnticipatedLoop {
 public:
  AnticipatedLoop(const Relaxation& r, const Topology& t, const ContactLists& contacts,
                  const Workspace& w)
      : r_(r), t_(t), contacts_(contacts), w_(w) {
    std::fill_n(w_.pending, r_.count, 0.0);
    if constexpr (kSkip) std::fill_n(w_.moved, r_.particles, Flag::set);
  }

  void renew() {
    if (begun_) apply_pending();
    begun_ = true;
    for (const std::uint32_t hub : w_.hubs) w_.hub_motion.set(hub, {0, 0, 0});
    for (std::size_t c = 0; c < r_.count; ++c) {
      if (kSkip && !is_set(w_.moved[r_.a[c]]) && !is_set(w_.moved[r_.b[c]])) continue;
      w_.error[c] = kDirections == Directions::constant ? error(r_, c) : renew_direction(r_, c);
      remind(c);
    }
    std::fill_n(w_.row_ready, r_.plain, Flag::clear);
    if constexpr (kSkip) std::fill_n(w_.moved, r_.particles, Flag::clear);
  }

  Sweep sweep() {
    Sweep sweep;
    if constexpr (kSkip) {
      sweep_flagged(sweep);
    } else {
      for (std::size_t c = 0; c < r_.plain; ++c) sweep.corrections += visit_plain(c);
      sweep.visits = static_cast<std::int64_t>(r_.plain);
    }
    for (std::size_t c = r_.plain; c < r_.count; ++c) sweep.corrections += visit_general(c);
    sweep.visits += static_cast<std::int64_t>(r_.count - r_.plain);
    return sweep;
  }

  void finish() { apply_pending(); }

 private:
  static constexpr std::size_t kFlagsPerWord = 8;

  /// Eight flags are read as one word: where all are clear, eight constraints are passed over at
  /// once. Where some are set all eight are compared, which is quicker than asking each.
  void sweep_flagged(Sweep& sweep) {
    for (std::size_t first = 0; first < r_.plain; first += kFlagsPerWord) {
      std::uint64_t flags;
      std::memcpy(&flags, w_.changed + first, sizeof flags);
      if (flags == 0) continue;
      const std::size_t last = std::min(first + kFlagsPerWord, r_.plain);
      sweep.visits += static_cast<std::int64_t>(last - first);
      for (std::size_t c = first; c < last; ++c) {
        w_.changed[c] = Flag::clear;
        sweep.corrections += visit_plain(c);
      }
    }
  }

  bool visit_plain(std::size_t c) {
    const double e = w_.error[c];
    const double change = impulse_change(r_, c, e, 0);
    if (change == 0) return false;
    w_.pending[c] += change;
    w_.error[c] = r_.limit < kUnlimited ? e - change / r_.effective_mass[c] : 0.0;
    if (r_.limit < kUnlimited) remind(c);
    if constexpr (kDirections == Directions::each) {
      push_later(c, change);
    } else {
      push_row(c, change);
    }
    if (contacts_.first != nullptr) {
      push_contacts(c, r_.a[c], -change);
      push_contacts(c, r_.b[c], change);
    }
    return true;
  }

  void push_later(std::size_t c, double change) {
    const Vector d = change * r_.n[c];
    const std::size_t end = t_.row_begin[c + 1];
    for (std::size_t k = t_.row_later[c]; k < end; ++k) {
      const std::size_t j = t_.row_constraint[k];
      w_.error[j] -= t_.row_weight[k] * dot(d, r_.n[j]);
      remind(j);
    }
  }

  void push_row(std::size_t c, double change) {
    if (!is_set(w_.row_ready[c])) build_row(c);
    const std::size_t end = t_.row_begin[c + 1];
    for (std::size_t k = t_.row_begin[c]; k < end; ++k) {
      const std::size_t j = t_.row_constraint[k];
      w_.error[j] -= w_.row_product[k] * change;
      remind(j);
    }
  }

  void build_row(std::size_t c) {
    const Vector n = r_.n[c];
    const std::size_t end = t_.row_begin[c + 1];
    for (std::size_t k = t_.row_begin[c]; k < end; ++k) {
      w_.row_product[k] = t_.row_weight[k] * dot(n, r_.n[t_.row_constraint[k]]);
    }
    w_.row_ready[c] = Flag::set;
  }

  void remind(std::size_t c) {
    if constexpr (kSkip) w_.changed[c] = Flag::set;
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
    if (contacts_.first == nullptr) return;
    for (auto k = contacts_.first[p]; k != kNoContact; k = contacts_.next[k]) {
      push(r_.pulling + k, p, d);
    }
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
      if (c >= r_.bilateral) r_.impulse[c] += w_.pending[c];
      w_.pending[c] = 0;
      if constexpr (kSkip) w_.moved[r_.a[c]] = w_.moved[r_.b[c]] = Flag::set;
    }
  }

  const Relaxation& r_;
  const Topology& t_;
  const ContactLists& contacts_;
  const Workspace& w_;
  bool begun_ = false;
};

}  // namespace weft::reference
