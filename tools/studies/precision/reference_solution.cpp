#include "tools/studies/precision/reference_solution.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace weft::tools::precision {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double kStrainTolerance = 1e-12;
constexpr int kMostIterations = 100;

Eigen::Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

std::vector<Vec3> to_vectors(const VectorXd& stacked) {
  std::vector<Vec3> vectors;
  for (Index i = 0; i < stacked.size(); i += 3) {
    vectors.push_back({stacked[i], stacked[i + 1], stacked[i + 2]});
  }
  return vectors;
}

/// RATTLE for the constraints g_c(x) = |x_a - x_b| - rest, with J = dg/dx (a row has the direction
/// n at a, -n at b) and W = M^-1, zero at fixed particles:
///
///   x1 = x0 + h v0 + h^2/2 g - W J(x0)^T lambda     with g(x1) = 0
///   v1 = (x1 - x0)/h + h/2 g - W J(x1)^T mu         with J(x1) v1 = 0
///
/// lambda by simplified Newton: J(x1) W J(x0)^T is replaced by A = J(x0) W J(x0)^T, whose factors
/// are at hand from the velocities of the step before. What that costs is iterations, since the
/// error itself is always that of the true positions.
class Rattle {
 public:
  explicit Rattle(const SceneDescription& scene)
      : x_(static_cast<Index>(3 * scene.positions.size())),
        v_(VectorXd::Zero(x_.size())),
        inverse_mass_(x_.size()),
        gravity_(x_.size()),
        jacobian_(0, x_.size()) {
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
      const auto at = static_cast<Index>(3 * i);
      x_.segment<3>(at) = to_eigen(scene.positions[i]);
      if (!scene.velocities.empty()) v_.segment<3>(at) = to_eigen(scene.velocities[i]);
      inverse_mass_.segment<3>(at).setConstant(1 / scene.masses[i]);
      gravity_.segment<3>(at) = to_eigen(scene.gravity);
    }
    for (const std::uint32_t fixed : scene.fixed) {
      for (VectorXd* vector : {&v_, &inverse_mass_, &gravity_}) {
        vector->segment<3>(3 * fixed).setZero();
      }
    }
    for (const Constraint& c : scene.constraints) {
      if (inverse_mass_[3 * c.a] > 0 || inverse_mass_[3 * c.b] > 0) constraints_.push_back(c);
    }
    lambda_ = VectorXd::Zero(static_cast<Index>(constraints_.size()));
    update_directions();
  }

  /// False: no impulses were found that keep the constraints.
  bool step(double h) {
    const VectorXd start = x_;
    if (!solve_positions(start + h * v_ + h * h / 2 * gravity_)) return false;
    v_ = (x_ - start) / h + h / 2 * gravity_;
    update_directions();
    const VectorXd mu = factors_.solve(jacobian_ * v_);
    v_ -= inverse_mass_.cwiseProduct(jacobian_.transpose() * mu);
    return factors_.info() == Eigen::Success;
  }

  Motion motion() const { return {to_vectors(x_), to_vectors(v_)}; }

 private:
  bool solve_positions(const VectorXd& free_flight) {
    VectorXd error(lambda_.size());
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      x_ = free_flight - inverse_mass_.cwiseProduct(jacobian_.transpose() * lambda_);
      if (measure(error) <= kStrainTolerance) return true;
      lambda_ += factors_.solve(error);
    }
    return false;
  }

  /// Fills in g(x) and returns the largest strain; infinity if x is no motion any more.
  double measure(VectorXd& error) const {
    double largest = 0;
    for (std::size_t c = 0; c < constraints_.size(); ++c) {
      const Constraint& constraint = constraints_[c];
      const double length =
          (x_.segment<3>(3 * constraint.a) - x_.segment<3>(3 * constraint.b)).norm();
      const double violation = length - constraint.rest_length;
      if (!std::isfinite(violation)) return std::numeric_limits<double>::infinity();
      error[static_cast<Index>(c)] = violation;
      largest = std::max(largest, std::abs(violation) / constraint.rest_length);
    }
    return largest;
  }

  /// J and the factors of J W J^T at the present positions.
  void update_directions() {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t c = 0; c < constraints_.size(); ++c) {
      const auto row = static_cast<int>(c);
      const auto a = static_cast<int>(3 * constraints_[c].a);
      const auto b = static_cast<int>(3 * constraints_[c].b);
      const Eigen::Vector3d n = (x_.segment<3>(a) - x_.segment<3>(b)).normalized();
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(row, a + k, n[k]);
        entries.emplace_back(row, b + k, -n[k]);
      }
    }
    jacobian_.resize(lambda_.size(), x_.size());
    jacobian_.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> matrix =
        jacobian_ * inverse_mass_.asDiagonal() * jacobian_.transpose();
    if (!is_analysed_) factors_.analyzePattern(matrix);
    is_analysed_ = true;
    factors_.factorize(matrix);
  }

  std::vector<Constraint> constraints_;
  VectorXd x_, v_, inverse_mass_, gravity_;  // three entries per particle
  VectorXd lambda_;                          // of the last step: where the next one starts
  RowMatrix jacobian_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
  bool is_analysed_ = false;
};

Result<void> check(const SceneDescription& scene) {
  if (!scene.spheres.empty()) return Error{"the reference solution knows no contacts"};
  if (!scene.membrane.empty()) return Error{"the reference solution knows no triangles of fabric"};
  for (const Constraint& c : scene.constraints) {
    if (c.kind == ConstraintKind::rope) return Error{"the reference solution knows no ropes"};
    if (c.compliance > 0) return Error{"the reference solution knows no springs"};
  }
  return {};
}

}  // namespace

Result<Motion> reference_solution(const SceneDescription& scene, double h, int steps) {
  if (const auto known = check(scene); !known) return Error{known.error()};
  Rattle rattle(scene);
  for (int step = 0; step < steps; ++step) {
    if (rattle.step(h)) continue;
    return Error{fmt::format("the reference solution found no impulses at t = {:g} s with h = {:g}",
                             step * h, h)};
  }
  return rattle.motion();
}

double trajectory_error(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference) {
  double largest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double distance = (to_eigen(positions[i]) - to_eigen(reference[i])).norm();
    if (std::isnan(distance)) return distance;
    largest = std::max(largest, distance);
  }
  return largest;
}

}  // namespace weft::tools::precision
