/// Chains, trees and bridges of rigid links and ropes that hang from one particle at most, solved
/// as one system: a load at the end of a chain reaches its beginning in the same sweep, for any
/// ratio of masses. A chain between two held particles may be too short, and an exact solution does
/// not distribute that error: other solvers do these chains.
///
/// The links act along their directions at the end of the substep: with C = (l^2 - L^2) / 2 of
/// each, whose gradient J is d at one end and -d at the other,
///
///     M (x - x*) = -J(x)^T lambda,     C(x) = 0
///
/// J is linear in x, so that Newton's step for both is
///
///     | M + G   J^T | | dx     |   |  0 |
///     | J       0   | | lambda | = | -C |,     G = sum of lambda over the links (1 -1; -1 1)
///
/// G keeps a taut chain straight: without it, by impulses along the predicted directions alone, a
/// chain with a heavy end shakes. G depends on lambda, so the system is solved again, from G = 0
/// on, until lambda changes little. The unknowns are ordered so that the factorisation has little
/// fill-in, and none in a tree.
///
/// A rope pulls alone: its law is lambda >= 0, C + J dx <= 0, and one of the two holds with
/// equality. Which ropes are taut is found by the same solutions (a primal-dual active set method:
/// Hintermueller, Ito, Kunisch, "The primal-dual active set strategy as a semismooth Newton
/// method", 2002), which begin with those that are not shorter than their length by more than the
/// tolerance.
///
/// A rope that becomes taut ends a motion, as the limit of an anchor does (arrivals.h): all
/// particles that taut links join to it go on at first order. BDF2 would let them bounce, since it
/// remembers their flight.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/linkage_factor.h"
#include "engine/solvers/small_steps/linkage_layout.h"
#include "engine/solvers/small_steps/substep.h"
#include "kernels/vectors.h"

namespace weft {

class Linkage {
 public:
  Linkage(const Model& model, const LinkageLayout& layout);

  bool empty() const { return layout_.empty(); }
  /// Moves the ends of all links. continues: the substep has been swept before.
  template <class Points>
  void sweep(const Points& points, const Relaxation& by, double tolerance, bool continues) {
    const ConstraintStore& s = model_.constraints;
    begin(continues);
    for (std::uint32_t c = 0; c < s.size(); ++c)
      take(c, points.difference(s.a[c], s.b[c]), by.left, tolerance);
    solve();
    for (const std::uint32_t slot : layout_.slots) {
      const double* by_axes = solution_.data() + layout_.row_of_slot[slot];
      points.move(slot, {by_axes[0], by_axes[1], by_axes[2]});
    }
  }
  /// After the last sweep of a substep: visits the slots whose motion a rope has ended.
  template <class Points, class Visit>
  void for_each_arrival(const Points& points, Visit&& visit) {
    const ConstraintStore& s = model_.constraints;
    bool any = false;
    for (std::size_t c = s.bilateral; c < s.size(); ++c) {
      if (impulse_[c] <= 0 || !was_slack(c, points.start_difference(s.a[c], s.b[c]))) continue;
      if (!std::exchange(any, true)) std::ranges::fill(arrives_, false);
      arrives_[s.a[c]] = arrives_[s.b[c]] = true;
    }
    if (!any) return;
    spread_arrivals();
    for (const std::uint32_t slot : layout_.slots) {
      if (arrives_[slot]) visit(slot);
    }
  }
  std::size_t slots() const { return layout_.slots.size(); }
  /// Constraints that the last sweep found out of tolerance.
  const std::vector<std::uint32_t>& out() const { return out_; }
  /// lambda of a constraint, since the substep began.
  double impulse(std::size_t constraint) const { return impulse_[constraint]; }
  std::size_t bytes() const;

 private:
  void begin(bool continues);
  void take(std::uint32_t c, kernels::Vector d, double left, double tolerance);
  void solve();
  void solve_once();
  bool find_taut();
  double update_tension();
  bool was_slack(std::size_t rope, kernels::Vector d) const;
  void spread_arrivals();

  bool is_rope(std::size_t c) const { return c >= model_.constraints.bilateral; }
  double lambda(std::size_t c) const {
    return solution_[static_cast<std::size_t>(layout_.row_of_link[c])];
  }

  const Model& model_;
  const LinkageLayout& layout_;
  LinkageFactor factor_;
  std::vector<double> values_;  // of the matrix
  std::vector<double> solution_;
  // Per constraint.
  std::vector<kernels::Vector> d_;
  std::vector<double> error_;    // C
  std::vector<double> impulse_;  // of the sweeps before
  std::vector<double> tension_;  // lambda, as G has it
  std::vector<std::uint8_t> is_taut_;
  std::vector<std::uint32_t> out_;
  std::vector<std::uint8_t> arrives_;  // per slot
};

}  // namespace weft
