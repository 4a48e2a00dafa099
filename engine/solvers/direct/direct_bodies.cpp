#include "engine/solvers/direct/direct_bodies.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

double compliance(const DirectSystem& system, const Tie& tie) {
  return system.softness(tie.index) + tuning::kBodyCompliance * (system.model.inverse_mass[tie.a] +
                                                                 system.model.inverse_mass[tie.b]);
}

Spring spring_of_tie(const DirectSystem& system, const Tie& tie) {
  return {{tie.a, tie.b}, {tie.n, -1 * tie.n}, tie.error, compliance(system, tie)};
}

Spring spring_of_second(const DirectSystem& system, const Tie& second) {
  const Tie& touch = system.touches[system.touch_of[second.b]];
  const double c = dot(touch.n, second.n);
  const double give = system.model.inverse_mass[second.b] * std::max(0.0, 1 - c * c);
  return {{second.a, touch.a},
          {second.n, -c * touch.n},
          second.error - c * touch.error,
          compliance(system, second) + give};
}

}  // namespace

bool DirectBodies::solve(DirectSystem& system, DirectFactor& factor) {
  if (!choose(system)) return false;
  if (bodies_.empty()) return true;
  fill_balance(system, factor);
  if (!solve_balance()) return false;
  const std::size_t rows = system.layout.rows();
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    const double* const column = solved_.data() + i * rows;
    for (std::size_t row = 0; row < rows; ++row) system.lambda[row] += motion_[i] * column[row];
  }
  return true;
}

/// Chooses the bodies that something acts on. Returns false if they are too many for this method.
bool DirectBodies::choose(const DirectSystem& system) {
  const DirectLayout& layout = system.layout;
  bodies_.clear();
  if (layout.bodies.empty()) return true;
  std::ranges::fill(column_of_, kNoIndex);
  const auto add = [&](std::uint32_t slot) {
    const std::uint32_t body = layout.body_of[slot];
    if (body == kNoIndex || column_of_[body] != kNoIndex) return;
    column_of_[body] = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back(slot);
  };
  for (const std::uint32_t slot : layout.bodies) {
    if (!layout.rows_at[slot].empty()) add(slot);
  }
  for (const Tie& tie : system.ties) {
    add(tie.a);
    add(tie.b);
  }
  for (const Tie& touch : system.touches) add(touch.a);
  for (const Tie& second : system.seconds) add(second.a);
  return bodies_.size() <= tuning::kMostBodies;
}

/// Fills the columns of B for one body: the change of the errors with its motion.
void DirectBodies::fill_column(const DirectSystem& system, std::size_t body) {
  const DirectLayout& layout = system.layout;
  const std::size_t rows = layout.rows();
  double* const column = columns_.data() + 3 * body * rows;
  const auto add = [&](std::size_t row, Vector v) {
    column[row] += v.x;
    column[row + rows] += v.y;
    column[row + 2 * rows] += v.z;
  };
  const auto end = [&](std::size_t row, std::uint32_t p, Vector v) {
    return (layout.a[row] == p ? 1 : -1) * v;
  };
  std::fill_n(column, 3 * rows, 0.0);
  for (const std::uint32_t row : layout.rows_at[bodies_[body]]) {
    add(row, end(row, bodies_[body], system.n(row)));
  }
  for (const Tie& touch : system.touches) {
    if (touch.a != bodies_[body]) continue;
    for (const std::uint32_t row : layout.rows_at[touch.b]) {
      add(row, end(row, touch.b, dot(system.n(row), touch.n) * touch.n));
    }
  }
}

/// (W^-1 + B^T A^-1 B + contacts) y = -B^T A^-1 e - contacts, lambda being A^-1 e.
void DirectBodies::fill_balance(const DirectSystem& system, DirectFactor& factor) {
  const std::size_t rows = system.layout.rows(), size = 3 * bodies_.size();
  columns_.resize(std::max(columns_.size(), size * rows));
  solved_.resize(std::max(solved_.size(), size * rows));
  for (std::size_t body = 0; body < bodies_.size(); ++body) fill_column(system, body);
  std::copy_n(columns_.data(), size * rows, solved_.data());
  for (std::size_t i = 0; i < size; ++i) factor.solve(solved_.data() + i * rows);
  balance_.assign(size * size, 0.0);
  motion_.assign(size, 0.0);
  const auto product = [&](const double* a, const double* b) {
    double sum = 0;
    for (std::size_t row = 0; row < rows; ++row) sum += a[row] * b[row];
    return sum;
  };
  for (std::size_t i = 0; i < size; ++i) {
    const double* const column = columns_.data() + i * rows;
    for (std::size_t j = 0; j <= i; ++j) {
      balance_[i * size + j] = product(column, solved_.data() + j * rows);
    }
    balance_[i * size + i] += 1 / system.model.inverse_mass[bodies_[i / 3]];
    motion_[i] = -product(column, system.lambda.data());
  }
  balance_touches(system);
  for (const Tie& tie : system.ties) balance_spring(system.layout, spring_of_tie(system, tie));
  for (const Tie& second : system.seconds) {
    balance_spring(system.layout, spring_of_second(system, second));
  }
}

/// A sphere that touches a particle carries the inertia of the particle along n.
void DirectBodies::balance_touches(const DirectSystem& system) {
  const std::size_t size = motion_.size();
  for (const Tie& touch : system.touches) {
    const std::uint32_t body = system.layout.body_of[touch.a];
    if (body == kNoIndex) continue;
    const std::size_t first = 3 * std::size_t{column_of_[body]};
    const double n[3] = {touch.n.x, touch.n.y, touch.n.z};
    const double mass = 1 / system.model.inverse_mass[touch.b];
    for (std::size_t i = 0; i < 3; ++i) {
      motion_[first + i] -= mass * touch.error * n[i];
      for (std::size_t j = 0; j <= i; ++j) {
        balance_[(first + i) * size + first + j] += mass * n[i] * n[j];
      }
    }
  }
}

void DirectBodies::balance_spring(const DirectLayout& layout, const Spring& spring) {
  const std::size_t size = motion_.size();
  std::size_t place[6];
  double n[6];
  std::size_t used = 0;
  for (std::size_t end = 0; end < 2; ++end) {
    const std::uint32_t body = layout.body_of[spring.slot[end]];
    if (body == kNoIndex) continue;
    for (std::size_t i = 0; i < 3; ++i) place[used + i] = 3 * std::size_t{column_of_[body]} + i;
    n[used] = spring.n[end].x;
    n[used + 1] = spring.n[end].y;
    n[used + 2] = spring.n[end].z;
    used += 3;
  }
  const double stiffness = 1 / spring.compliance;
  for (std::size_t i = 0; i < used; ++i) {
    motion_[place[i]] -= stiffness * spring.error * n[i];
    for (std::size_t j = 0; j < used; ++j) {
      if (place[j] > place[i]) continue;
      balance_[place[i] * size + place[j]] += stiffness * n[i] * n[j];
    }
  }
}

/// Solves the small system by a Cholesky factorisation in place.
bool DirectBodies::solve_balance() {
  const std::size_t size = motion_.size();
  double* const l = balance_.data();
  double* const y = motion_.data();
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = l[i * size + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * size + k] * l[j * size + k];
      if (i == j && !(sum > 0)) return false;
      l[i * size + j] = i == j ? std::sqrt(sum) : sum / l[j * size + j];
    }
    for (std::size_t k = 0; k < i; ++k) y[i] -= l[i * size + k] * y[k];
    y[i] /= l[i * size + i];
  }
  for (std::size_t i = size; i-- > 0;) {
    for (std::size_t k = i + 1; k < size; ++k) y[i] -= l[k * size + i] * y[k];
    y[i] /= l[i * size + i];
  }
  return true;
}

Vector DirectBodies::motion(const DirectLayout& layout, std::uint32_t slot) const {
  const std::uint32_t body = layout.body_of[slot];
  if (body == kNoIndex) return {0, 0, 0};
  const double* const y = motion_.data() + 3 * std::size_t{column_of_[body]};
  return {y[0], y[1], y[2]};
}

double DirectBodies::impulse(const DirectLayout& layout, const Spring& spring) const {
  const double error = spring.error + dot(spring.n[0], motion(layout, spring.slot[0])) +
                       dot(spring.n[1], motion(layout, spring.slot[1]));
  return error / spring.compliance;
}

double DirectBodies::impulse_of_tie(const DirectSystem& system, const Tie& tie) const {
  return impulse(system.layout, spring_of_tie(system, tie));
}

double DirectBodies::impulse_of_second(const DirectSystem& system, const Tie& second) const {
  return impulse(system.layout, spring_of_second(system, second));
}

std::size_t DirectBodies::bytes() const {
  return bytes_of(bodies_) + bytes_of(column_of_) + bytes_of(columns_) + bytes_of(solved_) +
         bytes_of(balance_) + bytes_of(motion_);
}

}  // namespace weft
