/// Bodies (spheres, and particles of many constraints: engine/solvers/direct/direct_layout.h) are
/// unknowns beside the matrix, by their motions y. With the bodies' motion the errors are e + B y,
/// so lambda = A^-1 (e + B y), and the balance of impulses of the bodies gives
///
///     (W^-1 + B^T A^-1 B + contacts) y = -B^T A^-1 e - contacts,
///
/// three back-substitutions for each body. Links between bodies have no inverse mass in A: they act
/// in this small system as very stiff springs, whose error the next iteration takes.
///
/// So does a second contact of a particle p, of the sphere s' with the normal n', while the touch
/// of s with n holds it: p moves along n as s does, so that the spring is one between the spheres,
/// of the error e' - c (e + n . y) + n' . y' with c = n . n', softened by the way that p may give,
/// w_p (1 - c^2). What its rows do to p across n comes with the next iteration.
#pragma once

#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// An impulse (error + n[0] . y[0] + n[1] . y[1]) / compliance, y the motions of two slots.
struct Spring {
  std::uint32_t slot[2];
  kernels::Vector n[2];
  double error, compliance;
};

class DirectBodies {
 public:
  static constexpr std::size_t kMostBodies = 16;

  explicit DirectBodies(const DirectLayout& layout) : column_of_(layout.bodies.size()) {}

  /// lambda, being A^-1 e, becomes A^-1 (e + B y). false: the system is not solvable.
  bool solve(DirectSystem& system, DirectFactor& factor);
  /// y of what stands at a slot.
  kernels::Vector motion(const DirectLayout& layout, std::uint32_t slot) const;
  /// The impulse of a tie or of a second contact, the bodies having moved.
  double impulse_of_tie(const DirectSystem& system, const Tie& tie) const;
  double impulse_of_second(const DirectSystem& system, const Tie& second) const;
  std::size_t bytes() const;

 private:
  bool choose(const DirectSystem& system);
  void fill_column(const DirectSystem& system, std::size_t body);
  void fill_balance(const DirectSystem& system, DirectFactor& factor);
  void balance_touches(const DirectSystem& system);
  void balance_spring(const DirectLayout& layout, const Spring& spring);
  double impulse(const DirectLayout& layout, const Spring& spring) const;
  bool solve_balance();

  std::vector<std::uint32_t> bodies_;     // slots of those that take part
  std::vector<std::uint32_t> column_of_;  // per body of the layout
  std::vector<double> columns_;           // B, three columns for each body
  std::vector<double> solved_;            // A^-1 B
  std::vector<double> balance_, motion_;  // the small system
};

}  // namespace weft
