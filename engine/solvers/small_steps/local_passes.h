/// Local passes: Gauss-Seidel over what is out of tolerance, and over nothing else (paper 4.3).
///
/// Each particle has a mask of 64 bits, one for each of its constraints. A constraint is looked at
/// if its bit is set at one of its ends, which clears both; where it is out of tolerance it is
/// relaxed, and the bits of all constraints at its ends are set for the next pass. It ends when no
/// bit is set. A particle with more constraints has no mask: these have their bits at their other
/// ends, or, where that has none either, are looked at in every pass.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/lists.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/laws.h"

namespace weft {

/// Of a run, for reports and bounds.
struct LocalWork {
  std::int64_t visits = 0, corrections = 0;
  bool done = true;  // nothing that was looked at is out of tolerance
};

struct LocalLimits {
  double tolerance = 0;          // strain
  double contact_tolerance = 0;  // m
  double omega = 1;
  std::int64_t most_visits = 0;
  LawStep laws{};  // with springs
};

class LocalPasses {
 public:
  explicit LocalPasses(const Model& model);

  /// Asks for all constraints of the slot, if it can move.
  void look_at(std::uint32_t slot);
  /// Asks for the constraint, and for all that share a particle with it.
  void look_near(std::uint32_t constraint) {
    look_at(model_.constraints.a[constraint]);
    look_at(model_.constraints.b[constraint]);
  }
  void look_everywhere();
  /// Of what was asked for, and not done: where a step was broken off.
  void forget();

  /// points: difference(a, b), the vector from slot b to slot a; move(slot, by), of a constraint;
  /// push(slot, by), of a contact. With springs also what laws.h asks of them.
  template <class Points>
  LocalWork run(Points& points, const ContactStore& contacts, const LocalLimits& limits);
  std::size_t bytes() const;

 private:
  struct Place {
    std::uint32_t slot = 0;
    std::uint64_t bit = 0;  // 0: the slot has no mask
  };
  void set(const Place& place) {
    if (place.bit == 0) return;
    if (next_[place.slot] == 0) waiting_.push_back(place.slot);
    next_[place.slot] |= place.bit;
  }
  template <class Points>
  bool relax(Points& points, std::uint32_t constraint, const LocalLimits& limits);
  template <class Points>
  bool relax_by_law(Points& points, std::uint32_t constraint, const LocalLimits& limits);
  template <class Points>
  bool push_apart(Points& points, const ContactStore& contacts, double least, LocalWork& work);
  void begin_pass();

  const Model& model_;
  Lists at_;                                 // slot -> constraints
  std::vector<std::uint8_t> bit_a_, bit_b_;  // per constraint: its number at its ends, or kNoBit
  std::vector<std::uint32_t> always_;
  std::vector<std::uint64_t> now_, next_;         // per slot
  std::vector<std::uint32_t> present_, waiting_;  // slots whose masks may not be empty
  static constexpr std::uint8_t kNoBit = 255;
};

template <class Points>
bool LocalPasses::relax(Points& points, std::uint32_t c, const LocalLimits& limits) {
  const ConstraintStore& s = model_.constraints;
  if (s.has_springs()) return relax_by_law(points, c, limits);
  const std::uint32_t a = s.a[c], b = s.b[c];
  const kernels::Vector d = points.difference(a, b);
  const double rest = s.rest_length[c], l = length(d), error = l - rest;
  const bool out =
      c < s.bilateral ? std::abs(error) > limits.tolerance * rest : error > limits.tolerance * rest;
  if (!out) return false;
  const kernels::Vector by =
      (limits.omega * error * s.effective_mass[c]) * kernels::direction(d, l);
  points.move(a, -model_.inverse_mass[a] * by);
  points.move(b, model_.inverse_mass[b] * by);
  look_at(a);
  look_at(b);
  return true;
}

template <class Points>
bool LocalPasses::relax_by_law(Points& points, std::uint32_t c, const LocalLimits& limits) {
  const ConstraintStore& s = model_.constraints;
  if (!limits.laws.is_kept(s, c)) return false;
  const LawVisit visit = visit_law(s, points, limits.laws.springs, c);
  if (!(std::abs(visit.violation()) > limits.tolerance * s.rest_length[c])) return false;
  apply_law(model_, points, visit, limits.omega, c);
  look_at(s.a[c]);
  look_at(s.b[c]);
  return true;
}

/// Whether one was deeper than `least`.
template <class Points>
bool LocalPasses::push_apart(Points& points, const ContactStore& contacts, double least,
                             LocalWork& work) {
  bool any = false;
  for (std::uint32_t k = 0; k < contacts.count(); ++k) {
    const std::uint32_t a = contacts.sphere[k], b = contacts.particle[k];
    const kernels::Vector d = points.difference(a, b);
    const double l = length(d), depth = contacts.distance[k] - l;
    ++work.visits;
    if (!(depth > least)) continue;
    const double wa = model_.inverse_mass[a], wb = model_.inverse_mass[b];
    const kernels::Vector by = (depth / (wa + wb)) * kernels::direction(d, l);
    points.push(a, wa * by);
    points.push(b, -wb * by);
    look_at(a);
    look_at(b);
    ++work.corrections;
    any = true;
  }
  return any;
}

template <class Points>
LocalWork LocalPasses::run(Points& points, const ContactStore& contacts,
                           const LocalLimits& limits) {
  LocalWork work;
  bool again = push_apart(points, contacts, 0, work);
  while (again || !waiting_.empty()) {
    if (work.visits >= limits.most_visits) {
      work.done = false;
      break;
    }
    begin_pass();
    const auto visit = [&](std::uint32_t c) {
      ++work.visits;
      if (relax(points, c, limits)) ++work.corrections;
    };
    for (const std::uint32_t slot : present_) {
      for (std::uint64_t bits = std::exchange(now_[slot], 0); bits != 0; bits &= bits - 1) {
        const std::uint32_t c = at_[slot][static_cast<std::size_t>(std::countr_zero(bits))];
        const bool is_a = model_.constraints.a[c] == slot;
        const std::uint8_t there = is_a ? bit_b_[c] : bit_a_[c];
        if (there != kNoBit) {
          now_[is_a ? model_.constraints.b[c] : model_.constraints.a[c]] &=
              ~(std::uint64_t{1} << there);
        }
        visit(c);
      }
    }
    for (const std::uint32_t c : always_) visit(c);
    again = push_apart(points, contacts, limits.contact_tolerance, work);
  }
  forget();
  return work;
}

}  // namespace weft
