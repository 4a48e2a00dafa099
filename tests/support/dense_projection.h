/// What a step of bars should come to, by dense matrices in double: the solution that the solvers
/// are measured by, as plain as it can be and good for some tens of particles.
///
///     J    one row per bar: n at its end a, -n at b          A = J M^-1 J^T
///     positions:   repeat  x -= M^-1 J^T A^-1 e,  J and e anew from x   (Newton's method)
///     velocities:          v -= M^-1 J^T A^-1 J v
///
/// With a step h given, bars may be springs: A's diagonal gets compliance / h^2, and that
/// times the sum of all impulses is taken off e.
#pragma once

#include <weft/weft.h>

#include <Eigen/Core>
#include <vector>

namespace weft::test {

class DenseProjection {
 public:
  /// At least one bar must be able to move.
  explicit DenseProjection(const SceneDescription& scene, double h = 0);

  /// Whether Newton's method brought all errors to rounding.
  bool project_positions(std::vector<Vec3>& x);
  /// At the positions x.
  void project_velocities(const std::vector<Vec3>& x, std::vector<Vec3>& v);

  /// The least of any A, its rows scaled to a diagonal of 1, that positions were projected with: 1
  /// is best, 0 is singular.
  double reciprocal_condition() const { return reciprocal_condition_; }
  /// The largest motion of a particle (along an axis) that errors of up to 1 call for: |M^-1 J^T
  /// A^-1| in the norm of the maximum.
  double motion_per_error() const;
  /// The largest sum of motions that single bars asked of a particle in the last projection of
  /// positions: w sum |lambda|.
  double largest_share() const { return largest_share_; }

 private:
  void form(const std::vector<Vec3>& x);
  double condition() const;

  std::vector<Constraint> bars_;  // those that can move
  std::vector<double> inverse_mass_;
  Eigen::MatrixXd jacobian_, matrix_;
  Eigen::VectorXd error_, inverse_;  // inverse masses, per coordinate
  Eigen::VectorXd softness_;         // per bar
  double reciprocal_condition_ = 1, largest_share_ = 0;
};

}  // namespace weft::test
