#include "tests/support/dense_projection.h"

#include <algorithm>

#include "tests/support/dense.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test {
namespace {

constexpr int kMostSolves = 30;
constexpr double kExact = 1e-14;  // strain; a length is known no better

void subtract(std::vector<Vec3>& from, const Eigen::VectorXd& motion) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    from[i] = from[i] - Vec3{motion[at], motion[at + 1], motion[at + 2]};
  }
}

}  // namespace

DenseProjection::DenseProjection(const SceneDescription& scene, double h) {
  const std::vector<bool> fixed = are_fixed(scene);
  inverse_.resize(3 * static_cast<Eigen::Index>(scene.positions.size()));
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    inverse_mass_.push_back(fixed[i] ? 0 : 1 / scene.masses[i]);
    inverse_.segment<3>(static_cast<Eigen::Index>(3 * i)).setConstant(inverse_mass_[i]);
  }
  for (const Constraint& c : scene.constraints) {
    if (!fixed[c.a] || !fixed[c.b]) bars_.push_back(c);
  }
  softness_.setZero(static_cast<Eigen::Index>(bars_.size()));
  for (std::size_t i = 0; h > 0 && i < bars_.size(); ++i) {
    softness_[static_cast<Eigen::Index>(i)] = bars_[i].compliance / (h * h);
  }
}

void DenseProjection::form(const std::vector<Vec3>& x) {
  const auto rows = static_cast<Eigen::Index>(bars_.size());
  jacobian_.setZero(rows, inverse_.size());
  error_.resize(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Constraint& bar = bars_[static_cast<std::size_t>(row)];
    const Vec3 d = x[bar.a] - x[bar.b];
    const Eigen::Vector3d n = Eigen::Vector3d(d.x, d.y, d.z) / length(d);
    jacobian_.row(row).segment<3>(3 * static_cast<Eigen::Index>(bar.a)) = n;
    jacobian_.row(row).segment<3>(3 * static_cast<Eigen::Index>(bar.b)) = -n;
    error_[row] = length(d) - bar.rest_length;
  }
  matrix_ = impulse_matrix(jacobian_, inverse_);
  matrix_.diagonal() += softness_;
}

bool DenseProjection::project_positions(std::vector<Vec3>& x) {
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bars_.size()));
  double worst = 0;
  for (int solves = 0; solves < kMostSolves; ++solves) {
    form(x);
    error_ -= softness_.cwiseProduct(impulse);
    worst = 0;
    for (Eigen::Index row = 0; row < error_.size(); ++row) {
      const double rest = bars_[static_cast<std::size_t>(row)].rest_length;
      worst = std::max(worst, std::abs(error_[row]) / rest);
    }
    reciprocal_condition_ = std::min(reciprocal_condition_, condition());
    if (worst <= kExact) break;
    const Eigen::VectorXd more = solved(matrix_, error_);
    impulse += more;
    subtract(x, motion_by(more, jacobian_, inverse_));
  }
  std::vector<double> share(x.size());
  for (std::size_t row = 0; row < bars_.size(); ++row) {
    const double size = std::abs(impulse[static_cast<Eigen::Index>(row)]);
    share[bars_[row].a] += size * inverse_mass_[bars_[row].a];
    share[bars_[row].b] += size * inverse_mass_[bars_[row].b];
  }
  largest_share_ = *std::ranges::max_element(share);
  return worst <= 10 * kExact;
}

void DenseProjection::project_velocities(const std::vector<Vec3>& x, std::vector<Vec3>& v) {
  form(x);
  const Eigen::VectorXd impulse = solved(matrix_, product(jacobian_, flat(v)));
  subtract(v, motion_by(impulse, jacobian_, inverse_));
}

double DenseProjection::condition() const {
  const Eigen::VectorXd scale = matrix_.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix_ * scale.asDiagonal();
  const Eigen::VectorXd values = eigenvalues(scaled);
  return values.minCoeff() / values.maxCoeff();
}

double DenseProjection::motion_per_error() const {
  const Eigen::MatrixXd response = inverse_.asDiagonal() * jacobian_.transpose();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(matrix_.rows(), matrix_.cols());
  const Eigen::MatrixXd motion = product(response, solved(matrix_, one));
  return motion.cwiseAbs().rowwise().sum().maxCoeff();
}

}  // namespace weft::test
