#include "engine/solvers/yarn/single_constraints.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

/// The difference is in double, because the errors computed from it may be as small as the rounding
/// error of a float.
template <class Pair>
[[gnu::always_inline]] inline Vector difference(const float* u, const Pair& pair,
                                                std::size_t stride) {
  const float *to = u + pair.a, *from = u + pair.b;
  const auto axis = [&](std::size_t k) {
    return static_cast<double>(to[k * stride]) - static_cast<double>(from[k * stride]);
  };
  return {axis(0), axis(1), axis(2)};
}

template <class Pair>
[[gnu::always_inline]] inline Vector difference(const float* base, const float* u, const Pair& pair,
                                                std::size_t stride) {
  return difference(base, pair, stride) + difference(u, pair, stride);
}

void move(float* x, Vector d, std::size_t stride) {
  x[0] += static_cast<float>(d.x);
  x[stride] += static_cast<float>(d.y);
  x[2 * stride] += static_cast<float>(d.z);
}

/// Moves both ends by their inverse mass times the impulse. A fixed end is not written to:
/// otherwise the next contact with the same fixed sphere would have to wait for the store.
template <class Pair>
void move_together(const Pair& pair, Vector impulse, float* u, std::size_t stride) {
  if (pair.wa > 0) move(u + pair.a, -pair.wa * impulse, stride);
  if (pair.wb > 0) move(u + pair.b, pair.wb * impulse, stride);
}

/// The part of an impulse that keeps the sign of the sum.
double clamped(int side, double& sum, double impulse) {
  if (side != 0) impulse = side * std::max(side * impulse, -side * sum);
  sum += impulse;
  return impulse;
}

}  // namespace

SingleConstraints::SingleConstraints(const Model& model, const Settings& settings)
    : model_(model),
      stride_(model.yarns().places.stride),
      tolerance_(settings.tolerance),
      contact_tolerance_(settings.contact_tolerance) {
  const ConstraintStore& store = model.constraints;
  for (std::size_t c = store.plain; c < store.size(); ++c) {
    add(store.a[c], store.b[c], store.rest_length[c], c < store.bilateral ? 0 : 1);
  }
  constraints_ = pairs_.size();
}

void SingleConstraints::add(std::uint32_t a, std::uint32_t b, double distance, int side) {
  const YarnLayout& yarns = model_.yarns();
  const double wa = model_.inverse_mass[a] * yarns.lightest;
  const double wb = model_.inverse_mass[b] * yarns.lightest;
  pairs_.push_back({yarns.places.of(a), yarns.places.of(b), side, distance, wa, wb, 1 / (wa + wb)});
}

void SingleConstraints::start(const SphereContacts& contacts, const SpringLaws* laws,
                              bool first_round) {
  from_start_ = false;
  if (laws != nullptr) take_laws(*laws);
  if (first_round) {
    pairs_.resize(constraints_);
    for (Pair& pair : pairs_) pair.sum = 0;
  }
  for (std::size_t k = pairs_.size() - constraints_; k < contacts.count(); ++k) {
    add(contacts.sphere[k], contacts.particle[k], contacts.distance[k], -1);
  }
}

void SingleConstraints::take_laws(const SpringLaws& laws) {
  for (std::size_t i = 0; i < constraints_; ++i) {
    const std::size_t c = model_.constraints.plain + i;
    Pair& pair = pairs_[i];
    pair.distance = laws.target[c];
    pair.softness = laws.softness[c] * model_.yarns().lightest;
    pair.reciprocal = 1 / (pair.wa + pair.wb + pair.softness);
  }
}

void SingleConstraints::keep_multipliers(SpringLaws& laws) const {
  for (std::size_t i = 0; i < constraints_; ++i) {
    laws.multiplier[model_.constraints.plain + i] = pairs_[i].sum * model_.yarns().lightest;
  }
}

void SingleConstraints::keep_start(const float* base, const float* u) {
  from_start_ = true;
  starts_.resize(constraints_);
  for (std::size_t i = 0; i < constraints_; ++i) {
    const Vector d = difference(base, u, pairs_[i], stride_);
    starts_[i] = direction(d, length(d));
  }
}

/// Whether a one-sided constraint is satisfied and has no impulse to take back. Most contacts are,
/// and this test needs no square root.
bool SingleConstraints::at_rest(const Pair& pair, Vector d) {
  return pair.side != 0 && pair.sum == 0 &&
         pair.side * (dot(d, d) - pair.distance * pair.distance) <= 0;
}

/// A constraint whose direction has turned too far from that of its impulses is not relaxed.
void SingleConstraints::relax(const float* base, float* u) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    const Vector d = difference(base, u, pair, stride_);
    if (at_rest(pair, d)) continue;
    const double l = length(d);
    Vector along = direction(d, l);
    double change = (l - pair.target()) * pair.reciprocal;
    if (from_start(i)) {
      const double cosine = dot(along, starts_[i]);
      if (cosine < tuning::kLeastCosine) continue;
      along = starts_[i];
      change /= cosine;
    }
    const double impulse = clamped(pair.side, pair.sum, change);
    if (impulse == 0) continue;
    move_together(pair, impulse * along, u, stride_);
  }
}

double SingleConstraints::violation(const float* base, const float* u) const {
  const auto error_of = [&](const Pair& pair) {
    return pair.side * (length(difference(base, u, pair, stride_)) - pair.target());
  };
  double ropes = 0, contacts = 0;
  for (std::size_t i = 0; i < constraints_; ++i) {
    const Pair& pair = pairs_[i];
    if (pair.sum != 0) ropes = std::max(ropes, -error_of(pair) / pair.distance);
  }
  // This loop has no branches, since they would be unpredictable.
  for (std::size_t i = constraints_; i < pairs_.size(); ++i) {
    const double error = error_of(pairs_[i]);
    const double acted = pairs_[i].sum != 0;
    contacts = std::max({contacts, error, -acted * error});
  }
  return std::max(ropes / tolerance_, contacts / contact_tolerance_);
}

/// Sets the error of a row. A one-sided constraint takes part if it is violated or has acted.
void SingleConstraints::set_error(std::size_t i, double error) {
  const Pair& pair = pairs_[i];
  Row& row = rows_[i];
  const bool active = row.near && (pair.side == 0 || pair.side * error > 0 || pair.sum != 0);
  if (!active) return;
  active_.push_back(static_cast<std::uint32_t>(i));
  row.residual = error;
  row.lambda = row.p = row.q = 0;
}

void SingleConstraints::make_rows() {
  rows_.resize(pairs_.size());
  active_.reserve(pairs_.size());
  active_.clear();
}

void SingleConstraints::linearise(const float* base, const float* u) {
  velocities_ = false;
  make_rows();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const Vector d = difference(base, u, pair, stride_);
    const double l = length(d);
    rows_[i].near = true;
    rows_[i].n = from_start(i) ? starts_[i] : direction(d, l);
    set_error(i, l - pair.target());
  }
}

void SingleConstraints::linearise_velocities(const float* base, const float* u) {
  velocities_ = true;
  make_rows();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const Vector d = difference(base, u, pair, stride_);
    const double l = length(d);
    const double slack = i < constraints_ ? tolerance_ * pair.distance : contact_tolerance_;
    rows_[i].near = pair.side * (l - pair.distance) >= -slack;
    rows_[i].n = direction(d, l);
  }
}

double SingleConstraints::read(const float* base, const float* u) {
  active_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    set_error(i, dot(rows_[i].n, difference(base, u, pairs_[i], stride_)));
  }
  double worst = 0;
  for (const std::uint32_t i : active_) {
    const double error = std::abs(rows_[i].residual);
    if (!(error <= worst)) worst = error;
    if (std::isnan(error)) break;
  }
  return worst;
}

simd::YarnProducts SingleConstraints::precondition(double alpha, double goal) {
  double product = 0, worst = 0;
  for (const std::uint32_t i : active_) {
    const Pair& pair = pairs_[i];
    Row& row = rows_[i];
    row.lambda += alpha * row.p;
    row.residual -= alpha * row.q;
    row.z = row.residual * pair.reciprocal;
    product += row.residual * row.z;
    const double unit = velocities_        ? 1
                        : i < constraints_ ? pair.distance
                                           : contact_tolerance_ / goal;
    worst = std::max(worst, std::abs(row.residual) / unit);
  }
  return {static_cast<float>(product), static_cast<float>(worst)};
}

void SingleConstraints::push(double beta, float* t) {
  for (const std::uint32_t i : active_) {
    Row& row = rows_[i];
    row.p = row.z + beta * row.p;
    if (row.p == 0) continue;
    move_together(pairs_[i], -row.p * row.n, t, stride_);
  }
}

double SingleConstraints::pull(const float* t) {
  double product = 0;
  for (const std::uint32_t i : active_) {
    Row& row = rows_[i];
    row.q = dot(row.n, difference(t, pairs_[i], stride_)) + pairs_[i].softness * row.p;
    product += row.p * row.q;
  }
  return product;
}

void SingleConstraints::finish(float* t) {
  for (const std::uint32_t i : active_) {
    Pair& pair = pairs_[i];
    const double impulse = clamped(pair.side, pair.sum, rows_[i].lambda);
    if (impulse == 0) continue;
    move_together(pair, impulse * rows_[i].n, t, stride_);
  }
}

std::size_t SingleConstraints::bytes() const {
  return bytes_of(pairs_) + bytes_of(starts_) + bytes_of(rows_) + bytes_of(active_);
}

}  // namespace weft
