/// Local passes: Gauss-Seidel over the items that are out of tolerance, and over no others (paper
/// 4.3).
///
/// An item is a constraint or a triangle of fabric. A pass visits it if its bit is set at one of
/// its ends (local_items.h), and clears its bits. If the item is out of tolerance it is corrected
/// to `mended`, which is within, and the bits of all items at its ends are set for the next pass.
/// Passes end when no bit is set. Items without a bit are visited in every pass.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/laws.h"
#include "engine/solvers/small_steps/local_items.h"
#include "engine/solvers/small_steps/membrane_laws.h"
#include "engine/spheres/sphere_contacts.h"

namespace weft {

/// The work of a run, for reports and bounds.
struct LocalWork {
  std::int64_t visits = 0, corrections = 0;
  bool done = true;  // nothing that was looked at is out of tolerance
};

struct LocalLimits {
  double tolerance = 0;          // strain
  double contact_tolerance = 0;  // m
  double mended = 0;             // strain
  std::int64_t most_visits = 0;  // besides one of each contact, by which a run begins
  LawStep laws{};                // with springs
};

class LocalPasses {
 public:
  LocalPasses(const Model& model, const LocalItems& items);

  /// The number of a triangle of fabric among all items.
  std::uint32_t item_of_element(std::uint32_t element) const {
    return items_.constraints + element;
  }
  /// Asks for all items of the slot, if it can move.
  void look_at(std::uint32_t slot);
  /// Asks for the item, and for all that share a particle with it.
  void look_near(std::uint32_t item) {
    for (const End& end : items_.ends(item)) look_at(end.slot);
  }
  void look_everywhere();
  bool is_asked() const { return !waiting_.empty(); }
  /// Forgets items that were asked for and not done: where a step was broken off.
  void forget();

  /// points: difference(a, b), the vector from slot b to slot a; move(slot, by), of a constraint;
  /// push(slot, by), of a contact. With springs also what laws.h asks of them, with triangles of
  /// fabric what membrane_laws.h does.
  template <class Points>
  LocalWork run(Points& points, const SphereContacts& contacts, const LocalLimits& limits);
  /// The error of the item's laws, a strain. A rigid constraint has none.
  template <class Points>
  double law_error(const Points& points, const LawStep& step, std::uint32_t item) const;
  std::size_t bytes() const;

 private:
  using End = LocalItems::End;
  template <class Points>
  bool relax(Points& points, std::uint32_t item, const LocalLimits& limits);
  template <class Points>
  bool relax_constraint(Points& points, std::uint32_t constraint, const LocalLimits& limits);
  template <class Points>
  bool relax_triangle(Points& points, std::uint32_t element, const LocalLimits& limits);
  template <class Points>
  bool relax_by_law(Points& points, std::uint32_t constraint, const LocalLimits& limits);
  template <class Points>
  bool push_apart(Points& points, const SphereContacts& contacts, double least, LocalWork& work);
  /// One of what was asked for. Returns false where visits were used up before its end.
  template <class Points>
  bool pass(Points& points, const LocalLimits& limits, std::int64_t most_visits, LocalWork& work);
  void begin_pass();
  void break_off();

  const Model& model_;
  const LocalItems& items_;
  std::vector<std::uint64_t> now_, next_;         // per slot
  std::vector<std::uint32_t> present_, waiting_;  // slots whose masks may not be empty
};

template <class Points>
double LocalPasses::law_error(const Points& points, const LawStep& step, std::uint32_t item) const {
  if (item >= items_.constraints)
    return violation_of_element(model_.membrane, points, step, item - items_.constraints);
  const ConstraintStore& s = model_.constraints;
  const bool is_law = s.has_springs() && s.compliance[item] > 0;
  return is_law ? violation_of_law(s, points, step, item) : 0;
}

template <class Points>
bool LocalPasses::relax(Points& points, std::uint32_t item, const LocalLimits& limits) {
  const bool is_out = item < items_.constraints
                          ? relax_constraint(points, item, limits)
                          : relax_triangle(points, item - items_.constraints, limits);
  if (is_out) look_near(item);
  return is_out;
}

template <class Points>
bool LocalPasses::relax_constraint(Points& points, std::uint32_t c, const LocalLimits& limits) {
  const ConstraintStore& s = model_.constraints;
  if (s.has_springs()) return relax_by_law(points, c, limits);
  const std::uint32_t a = s.a[c], b = s.b[c];
  const kernels::Vector d = points.difference(a, b);
  const double rest = s.rest_length[c], l = length(d), error = l - rest;
  const bool out =
      c < s.bilateral ? std::abs(error) > limits.tolerance * rest : error > limits.tolerance * rest;
  if (!out) return false;
  const double beyond = reference::beyond(error, limits.mended * rest);
  const kernels::Vector by = (beyond * s.effective_mass[c]) * kernels::direction(d, l);
  points.move(a, -model_.inverse_mass[a] * by);
  points.move(b, model_.inverse_mass[b] * by);
  return true;
}

template <class Points>
bool LocalPasses::relax_by_law(Points& points, std::uint32_t c, const LocalLimits& limits) {
  const ConstraintStore& s = model_.constraints;
  if (!limits.laws.is_kept(s, c)) return false;
  LawVisit visit = visit_law(s, points, limits.laws.springs, c);
  if (!(std::abs(visit.violation()) > limits.tolerance * s.rest_length[c])) return false;
  visit.residual = reference::beyond(visit.residual, limits.mended * s.rest_length[c]);
  apply_law(model_, points, visit, 1, c);
  return true;
}

template <class Points>
bool LocalPasses::relax_triangle(Points& points, std::uint32_t element, const LocalLimits& limits) {
  const MembraneStore& s = model_.membrane;
  if (!(violation_of_element(s, points, limits.laws, element) > limits.tolerance)) return false;
  relax_element(model_, points, limits.laws, 1, element, limits.mended);
  return true;
}

/// Whether one was deeper than `least`.
template <class Points>
bool LocalPasses::push_apart(Points& points, const SphereContacts& contacts, double least,
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
LocalWork LocalPasses::run(Points& points, const SphereContacts& contacts,
                           const LocalLimits& limits) {
  LocalWork work;
  bool again = push_apart(points, contacts, 0, work);
  const std::int64_t most_visits = limits.most_visits + work.visits;
  while (again || !waiting_.empty()) {
    work.done = pass(points, limits, most_visits, work) &&
                work.visits + static_cast<std::int64_t>(contacts.count()) <= most_visits;
    if (!work.done) break;
    again = push_apart(points, contacts, limits.contact_tolerance, work);
  }
  forget();
  return work;
}

template <class Points>
bool LocalPasses::pass(Points& points, const LocalLimits& limits, std::int64_t most_visits,
                       LocalWork& work) {
  begin_pass();
  const auto visit = [&](std::uint32_t item) {
    ++work.visits;
    if (relax(points, item, limits)) ++work.corrections;
  };
  for (const std::uint32_t slot : present_) {
    for (std::uint64_t bits = std::exchange(now_[slot], 0); bits != 0; bits &= bits - 1) {
      if (work.visits >= most_visits) {
        break_off();
        return false;
      }
      const std::uint32_t item = items_.at[slot][static_cast<std::size_t>(std::countr_zero(bits))];
      for (const End& end : items_.ends(item)) now_[end.slot] &= ~end.mask();
      visit(item);
    }
  }
  for (const std::uint32_t item : items_.unmasked) {
    if (work.visits >= most_visits) return false;
    visit(item);
  }
  return true;
}

}  // namespace weft
