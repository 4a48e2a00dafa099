#include "tests/support/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace weft::test {

Eigen::VectorXd flat(const std::vector<Vec3>& vectors) {
  Eigen::VectorXd result(3 * static_cast<Eigen::Index>(vectors.size()));
  Eigen::Index i = 0;
  for (const Vec3 v : vectors) {
    for (const double value : {v.x, v.y, v.z}) result[i++] = value;
  }
  return result;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }
Eigen::VectorXd product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) { return a * x; }

Eigen::MatrixXd impulse_matrix(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& inverse) {
  const Eigen::MatrixXd response = inverse.asDiagonal() * jacobian.transpose();
  return product(jacobian, response);
}

Eigen::VectorXd motion_by(const Eigen::VectorXd& impulse, const Eigen::MatrixXd& jacobian,
                          const Eigen::VectorXd& inverse) {
  return inverse.cwiseProduct(jacobian.transpose() * impulse);
}

Eigen::VectorXd solved(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::MatrixXd column = b;
  return solved(a, column);
}
Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& a) {
  // In two parts: whole, the solver can do eigenvectors as well, and that is compiled.
  const Eigen::Tridiagonalization<Eigen::MatrixXd> same(a);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(same.diagonal(), same.subDiagonal(), Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

}  // namespace weft::test
