/// The direct solver: every impulse of a step at once.
///
/// Along frozen directions n the impulses lambda that remove the errors e solve a linear system,
///
///     A lambda = e,     A = J M^-1 J^T,     then x -= M^-1 J^T lambda,
///
/// J having +n at a constraint's end a and -n at its end b. Renewing directions and errors after
/// each solve is Newton's method for the projection onto the constraints: the error is squared
/// each time. Velocities need one solve, for they are linear.
///
/// One-sided constraints (an active set). A rope that is taut, a contact that overlaps, or one that
/// has accumulated an impulse in this step, takes part as an equation. As everywhere in weft it is
/// the sum of its impulses that is clamped at 0: whoever would pull too much gives back what it
/// had, and leaves the set once it is slack. The outer loop sees the errors that this leaves.
///   A rope outside the set keeps its row: without direction, it couples with nothing.
///   A contact needs no row. Its particle p may not move along n but as the sphere does: its
///   inverse mass becomes w_p (I - n n^T), the matrix keeps its pattern. Were a contact a row, a
///   free sphere would couple all its contacts with each other, a dense block of hundreds.
///
/// Bodies (spheres and hubs, engine/solvers/direct_layout.h) are unknowns beside the matrix, by
/// their motions y. With the bodies' motion the errors are e + B y, so lambda = A^-1 (e + B y), and
/// the balance of impulses of the bodies gives
///
///     (W^-1 + B^T A^-1 B + contacts) y = -B^T A^-1 e - contacts,
///
/// three back-substitutions for each body. Links between bodies have no inverse mass in A: they act
/// in this small system as very stiff springs, whose error the next iteration takes.
///
/// Newton's method fails where a step bends edges by much of their length, where masses differ by
/// thousands, and where A is singular and the errors inconsistent (compressed straight chains).
/// That is seen by errors that no longer fall. The answer is to start again from the predicted
/// state with sweeps of Gauss-Seidel, which take the short waves out, and to try again from there,
/// with four times as many sweeps after each failure; Settings::max_iterations bounds the sum.
///
/// Stiff attempt. Under a heavy end the impulses are so large that a light particle at the least
/// kink is thrown far: the turning of n, which A leaves out, matters most. The projection onto the
/// constraints is stationary where
///
///     g = M (x - x~) + J^T lambda = 0,     x~ predicted, J at x itself
///
/// and the derivative of J^T lambda is the geometric stiffness of the tensions (Tournier et al.
/// 2015), here bounded from above by a block for each particle (Andrews et al. 2017):
///
///     W~ = (M + sum over its constraints of 2 |lambda| / rest (1 - n n^T))^-1
///     (J W~ J^T) d = e - J W~ g,     x -= W~ (g + J^T d),     lambda += d
///
/// It converges slowly but surely: a chain of 20 under 10^6 times its particles' mass needs it, on
/// sheets of equal masses sweeps are faster. So it comes before them, but only where masses differ
/// by more than kUneven, and in scenes of rows alone. At the end what is left of g is applied, so
/// that momentum is kept to rounding.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/contacts.h"
#include "engine/model.h"
#include "engine/solvers/direct_factor.h"
#include "kernels/loop.h"

namespace weft {

/// A symmetric 3 x 3 matrix.
struct Symmetric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// Gauss-Seidel on the same positions: at most so many iterations; first: nothing came before.
using Sweeps = std::function<kernels::LoopResult(bool first, int max_iterations)>;

class DirectSolver {
 public:
  DirectSolver(const Model& model, const Settings& settings);

  /// Moves x until every constraint and listed contact is within tolerance. first_round: contacts
  /// were found anew, accumulated impulses start at 0. LoopResult::iterations counts solves, and
  /// sweeps where they were needed.
  kernels::LoopResult solve_positions(kernels::VectorsView x, const ContactStore& contacts,
                                      bool first_round, int max_iterations, const Sweeps& sweeps);
  /// Corrects v at the positions x.
  kernels::LoopResult correct_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                         const ContactStore& contacts, const Sweeps& sweeps);
  std::size_t bytes() const;

 private:
  enum class Outcome : std::uint8_t { converged, failed, exhausted };

  /// A constraint or contact that is no row, with its direction and error.
  struct Tie {
    std::uint32_t index = 0;  // of the constraint; contacts are counted behind the constraints
    std::uint32_t a = 0, b = 0;
    kernels::Vector n{};
    double error = 0, impulse = 0;
  };

  void start(const ContactStore& contacts, bool first_round);
  Outcome iterate(kernels::VectorsView x, const ContactStore& contacts, int max_iterations,
                  kernels::LoopResult& result);
  Outcome iterate_stiff(kernels::VectorsView x, const ContactStore& contacts, int max_iterations,
                        kernels::LoopResult& result);
  int stiff_solves() const;
  double find_imbalance(kernels::VectorsView x);
  void apply_imbalance(kernels::VectorsView x);
  void stiffen();
  void solve_stiff(kernels::VectorsView x);
  Outcome iterate_fixed(kernels::VectorsView x, const ContactStore& contacts,
                        kernels::LoopResult& result);
  Outcome iterate_velocities(kernels::VectorsView x, kernels::VectorsView v,
                             const ContactStore& contacts, kernels::LoopResult& result);

  // Each renews directions and errors and the active set; returns the largest error in tolerances.
  double measure_positions(kernels::VectorsView x, const ContactStore& contacts);
  double measure_velocities(kernels::VectorsView x, kernels::VectorsView v,
                            const ContactStore& contacts);
  template <class Read>
  double measure(const ContactStore& contacts, Read&& read);
  void add_contact(const Tie& contact);
  double tolerance(std::uint32_t index) const;
  int side(std::uint32_t index) const;

  bool solve();  // lambda_ and the impulses of ties, from directions and errors
  void apply(kernels::VectorsView u) const;
  void absorb_touches();
  void factorise();
  bool choose_bodies();
  void fill_column(std::size_t body);
  void fill_balance();
  void balance_touches(std::size_t size);
  void balance_ties(std::size_t size);
  bool solve_balance();
  void clamp_impulses();
  double clamped(std::uint32_t index, double impulse);
  kernels::Vector motion_of(std::uint32_t slot) const;

  const Model& model_;
  const DirectLayout& layout_;
  const Settings settings_;
  DirectFactor factor_;

  std::vector<double> nx_, ny_, nz_;  // per row
  std::vector<double> lambda_;        // per row: errors, then impulses
  std::vector<double> total_;         // accumulated impulses, constraints then contacts
  std::int64_t active_ = 0;           // constraints and contacts that take part
  kernels::Vectors start_;            // where an attempt begins
  bool uneven_ = false;               // the stiff attempt may be needed
  kernels::Vectors g_;                // imbalance, per slot
  std::vector<Symmetric> soft_;       // W~, per slot
                                      // where an attempt begins

  std::vector<Tie> touches_;              // contacts with a particle of the matrix
  std::vector<std::uint32_t> touch_of_;   // per slot; with spheres only
  std::vector<Tie> ties_;                 // links between bodies, contacts included
  std::vector<std::uint32_t> bodies_;     // those that take part
  std::vector<std::uint32_t> column_of_;  // per body of the layout
  std::vector<double> columns_;           // B, three columns of rows() for each body
  std::vector<double> solved_;            // A^-1 B
  std::vector<double> balance_, motion_;  // the small system
};

}  // namespace weft
