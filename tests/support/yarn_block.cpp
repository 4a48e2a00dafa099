#include "tests/support/yarn_block.h"

#include <Eigen/LU>

namespace weft::test {

std::vector<kernels::Vector> directions(const BlockOfYarns& b, const kernels::Vectors& x,
                                        std::uint32_t lane) {
  std::vector<kernels::Vector> n;
  for (std::uint32_t k = 0; k + 1 < BlockOfYarns::length(lane); ++k) {
    const kernels::Vector d = x[b.slot_of(k, lane)] - x[b.slot_of(k + 1, lane)];
    n.push_back((1 / kernels::length(d)) * d);
  }
  return n;
}

std::vector<kernels::Vector> solved_densely(const BlockOfYarns& b, std::uint32_t lane,
                                            const kernels::Vectors& at,
                                            const std::vector<kernels::Vector>& n,
                                            const std::vector<kernels::Vector>& s,
                                            const Eigen::VectorXd& e) {
  std::vector<kernels::Vector> x;
  std::vector<double> w;
  for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
    x.push_back(at[b.slot_of(k, lane)]);
    w.push_back(static_cast<double>(b.rows[k].inverse_mass[lane]));
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(e.size(), e.size());
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    a(i, i) = (w[k] + w[k + 1]) * kernels::dot(n[k], s[k]) +
              b.softness(static_cast<std::uint32_t>(k), lane);
    if (k == 0) continue;
    a(i, i - 1) = -w[k] * kernels::dot(n[k], s[k - 1]);
    a(i - 1, i) = -w[k] * kernels::dot(n[k - 1], s[k]);
  }
  const Eigen::VectorXd lambda = a.partialPivLu().solve(e);
  for (std::size_t k = 0; k < n.size(); ++k) {
    const double impulse = lambda[static_cast<Eigen::Index>(k)];
    x[k] = x[k] + (-w[k] * impulse) * s[k];
    x[k + 1] = x[k + 1] + (w[k + 1] * impulse) * s[k];
  }
  return x;
}

Eigen::VectorXd length_errors(const BlockOfYarns& b, std::uint32_t lane) {
  Eigen::VectorXd e(BlockOfYarns::length(lane) - 1);
  for (std::uint32_t k = 0; k + 1 < BlockOfYarns::length(lane); ++k) {
    const kernels::Vector d = b.x[b.slot_of(k, lane)] - b.x[b.slot_of(k + 1, lane)];
    e[k] = kernels::length(d) - static_cast<double>(b.rows[k].rest[lane]) - b.give(k, lane);
  }
  return e;
}

std::vector<kernels::Vector> solved_densely(const BlockOfYarns& b, std::uint32_t lane) {
  const auto n = directions(b, b.x, lane);
  return solved_densely(b, lane, b.x, n, n, length_errors(b, lane));
}

kernels::Vectors scattered(kernels::Vectors v, double size) {
  Random random(11);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec3 d = random.in_box(size);
    v.set(i, v[i] + kernels::Vector{d.x, d.y, d.z});
  }
  return v;
}

double largest_strain(const BlockOfYarns& b, const kernels::Vectors& x) {
  double largest = 0;
  for (std::uint32_t lane = 2; lane < kernels::kLanes; ++lane) {
    for (std::uint32_t k = 0; k + 1 < BlockOfYarns::length(lane); ++k) {
      const double l = kernels::length(x[b.slot_of(k, lane)] - x[b.slot_of(k + 1, lane)]);
      const double rest = static_cast<double>(b.rows[k].rest[lane]);
      largest = std::max(largest, std::abs(l - rest - b.give(k, lane)) / rest);
    }
  }
  return largest;
}

}  // namespace weft::test
