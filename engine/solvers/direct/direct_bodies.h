/// Bodies (spheres, and particles of many constraints: engine/solvers/direct/direct_layout.h) have
/// their motions y as unknowns beside the matrix. When the bodies move, the errors are e + B y, so
/// that lambda = A^-1 (e + B y), and the balance of the bodies' impulses gives
///
///     (W^-1 + B^T A^-1 B + contacts) y = -B^T A^-1 e - contacts,
///
/// which takes three back-substitutions for each body. Links between bodies have no row in A: they
/// act in this small system as very stiff springs, whose remaining error the next iteration
/// removes.
///
/// A second contact of a particle p, with the sphere s' and the normal n', is also a spring while
/// the first contact, with s and n, holds it. The particle moves along n as s does, so that the
/// spring acts between the two spheres. Its error is e' - c (e + n . y) + n' . y' with c = n . n',
/// and its compliance includes the inverse mass w_p (1 - c^2) with which p can give way. The effect
/// of the rows of p across n is left to the next iteration.
#pragma once

#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_layout.h"
#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// A spring between two slots with the motions y[0] and y[1]. Its impulse is (error + n[0] . y[0] +
/// n[1] . y[1]) / compliance.
struct Spring {
  std::uint32_t slot[2];
  kernels::Vector n[2];
  double error, compliance;
};

class DirectBodies {
 public:
  explicit DirectBodies(const DirectLayout& layout) : column_of_(layout.bodies.size()) {}

  /// Turns lambda = A^-1 e into A^-1 (e + B y). Returns false if the system cannot be solved.
  bool solve(DirectSystem& system, DirectFactor& factor);
  /// The motion y of the body at a slot; 0 if there is none.
  kernels::Vector motion(const DirectLayout& layout, std::uint32_t slot) const;
  /// The impulse of a tie or of a second contact after the motion of the bodies.
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

  std::vector<std::uint32_t> bodies_;     // slots of the bodies that take part
  std::vector<std::uint32_t> column_of_;  // per body of the layout: its place in bodies_
  std::vector<double> columns_;           // B, three columns for each body
  std::vector<double> solved_;            // A^-1 B
  std::vector<double> balance_, motion_;  // the small system
};

}  // namespace weft
