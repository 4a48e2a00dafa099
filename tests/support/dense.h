/// What tests ask of dense matrices in double. Eigen's products and decompositions are compiled
/// here: each takes seconds in every file that spells one out.
#pragma once

#include <weft/weft.h>

#include <Eigen/Core>
#include <vector>

namespace weft::test {

/// x, y, z of each.
Eigen::VectorXd flat(const std::vector<Vec3>& vectors);

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x);
/// J M^-1 J^T
Eigen::MatrixXd impulse_matrix(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& inverse);
/// M^-1 J^T impulse
Eigen::VectorXd motion_by(const Eigen::VectorXd& impulse, const Eigen::MatrixXd& jacobian,
                          const Eigen::VectorXd& inverse);

/// Of a symmetric matrix.
Eigen::VectorXd solved(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& a);

}  // namespace weft::test
