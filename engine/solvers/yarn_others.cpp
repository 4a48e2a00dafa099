#include "engine/solvers/yarn_others.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"

namespace weft {
namespace {

using kernels::Vector;

Vector difference(const float* u, std::uint32_t a, std::uint32_t b) {
  const auto axis = [&](std::size_t k) {
    return static_cast<double>(u[4 * a + k]) - static_cast<double>(u[4 * b + k]);
  };
  return {axis(0), axis(1), axis(2)};
}

Vector difference(const float* base, const float* u, std::uint32_t a, std::uint32_t b) {
  return difference(base, a, b) + difference(u, a, b);
}

void move(float* u, std::uint32_t slot, Vector d) {
  u[4 * slot] += static_cast<float>(d.x);
  u[4 * slot + 1] += static_cast<float>(d.y);
  u[4 * slot + 2] += static_cast<float>(d.z);
}

/// Each by its inverse mass times the impulse. What is fixed is not even written to: every next
/// contact with a fixed sphere would wait for it (hang_sphere: a fifth of a step).
void move_together(std::uint32_t a, double wa, std::uint32_t b, double wb, Vector impulse,
                   float* u) {
  if (wa > 0) move(u, a, -wa * impulse);
  if (wb > 0) move(u, b, wb * impulse);
}

Vector direction(Vector d, double length) {
  return length > 0 ? (1 / length) * d : Vector{0, 1, 0};  // coinciding: any parts them
}

/// The part of an impulse that keeps the sum on its side of 0.
double clamped(int side, double& sum, double impulse) {
  if (side != 0) impulse = side * std::max(side * impulse, -side * sum);
  sum += impulse;
  return impulse;
}

}  // namespace

YarnOthers::YarnOthers(const Model& model, const Settings& settings)
    : model_(model),
      contact_tolerance_(settings.contact_tolerance),
      heaviest_(std::ranges::max(model.inverse_mass)) {
  const ConstraintStore& store = model.constraints;
  for (std::size_t c = store.plain; c < store.size(); ++c) {
    add(store.a[c], store.b[c], store.rest_length[c], c < store.bilateral ? 0 : 1);
  }
  constraints_ = pairs_.size();
}

void YarnOthers::add(std::uint32_t a, std::uint32_t b, double distance, int side) {
  const double wa = model_.inverse_mass[a] / heaviest_, wb = model_.inverse_mass[b] / heaviest_;
  pairs_.push_back({a, b, side, distance, wa, wb});
}

void YarnOthers::start(const ContactStore& contacts, bool first_round) {
  if (first_round) {
    pairs_.resize(constraints_);
    for (Pair& pair : pairs_) pair.sum = 0;
  }
  for (std::size_t k = pairs_.size() - constraints_; k < contacts.count(); ++k) {
    add(contacts.sphere[k], contacts.particle[k], contacts.distance[k], -1);
  }
}

void YarnOthers::relax(const float* base, float* u) {
  for (Pair& pair : pairs_) {
    const Vector d = difference(base, u, pair.a, pair.b);
    const double l = length(d);
    const double impulse = clamped(pair.side, pair.sum, (l - pair.distance) / (pair.wa + pair.wb));
    if (impulse == 0) continue;
    const Vector n = direction(d, l);
    move_together(pair.a, pair.wa, pair.b, pair.wb, impulse * n, u);
  }
}

double YarnOthers::penetration(const float* base, const float* u) const {
  double deepest = 0;
  for (std::size_t k = constraints_; k < pairs_.size(); ++k) {
    const Pair& pair = pairs_[k];
    deepest = std::max(deepest, pair.distance - length(difference(base, u, pair.a, pair.b)));
  }
  return deepest;
}

void YarnOthers::linearise(const float* base, const float* u) {
  rows_.resize(pairs_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const Vector d = difference(base, u, pair.a, pair.b);
    const double l = length(d), error = l - pair.distance;
    const bool active = pair.side == 0 || pair.side * error > 0 || pair.sum != 0;
    rows_[i] = {};
    if (!active) continue;
    rows_[i].n = direction(d, l);
    rows_[i].residual = error;
  }
}

simd::YarnProducts YarnOthers::precondition(double alpha, double goal) {
  double product = 0, worst = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    Row& row = rows_[i];
    row.lambda += alpha * row.p;
    row.residual -= alpha * row.q;
    row.z = row.residual / (pair.wa + pair.wb);
    product += row.residual * row.z;
    const double unit = i < constraints_ ? pair.distance : contact_tolerance_ / goal;
    worst = std::max(worst, std::abs(row.residual) / unit);
  }
  return {static_cast<float>(product), static_cast<float>(worst)};
}

void YarnOthers::push(double beta, float* t) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Row& row = rows_[i];
    row.p = row.z + beta * row.p;
    if (row.p == 0) continue;
    move_together(pairs_[i].a, pairs_[i].wa, pairs_[i].b, pairs_[i].wb, -row.p * row.n, t);
  }
}

double YarnOthers::pull(const float* t) {
  double product = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Row& row = rows_[i];
    row.q = dot(row.n, difference(t, pairs_[i].a, pairs_[i].b));
    product += row.p * row.q;
  }
  return product;
}

void YarnOthers::finish(float* u) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    const double impulse = clamped(pair.side, pair.sum, rows_[i].lambda);
    if (impulse == 0) continue;
    move_together(pair.a, pair.wa, pair.b, pair.wb, impulse * rows_[i].n, u);
  }
}

std::size_t YarnOthers::bytes() const { return bytes_of(pairs_) + bytes_of(rows_); }

}  // namespace weft
