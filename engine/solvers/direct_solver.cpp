#include "engine/solvers/direct_solver.h"
#include "engine/bytes_of.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {
namespace {

using kernels::LoopResult;
using kernels::Vector;
using kernels::VectorsView;

/// In tolerances. What is within tolerance is solved all the same, once: left alone it would grow
/// until a later step had to remove all of it at once, as a blow.
constexpr double kNegligible = 1e-6;
/// The strain that solves aim at where the tolerance is larger: one more solve takes the error from
/// 1 % far below that, and the next steps have no noise to fight (corners, 41 x 41, 4 substeps, 1
/// %: 30 ms a frame and 0.45 J gained without it).
constexpr double kGoal = 1e-5;
constexpr int kMostSolves = 60;          // of one attempt; two or three are usual
constexpr int kPatience = 4;             // solves that need not halve the error
constexpr int kFirstSweeps = 32;         // of the answer to the first failure
constexpr int kMoreSweeps = 4;           // times as many for each further one
constexpr double kUneven = 100;          // ratio of masses from which the stiff attempt is made
constexpr int kMostStiffSolves = 20000;  // of a small scene
constexpr std::size_t kStiffWork = 100'000'000;  // entries of all factors of a large one
constexpr std::size_t kMostBodies = 16;
constexpr double kLinkShift = 1e-8;  // of w_a + w_b: the spring of a link between bodies

void copy(VectorsView from, VectorsView to, std::size_t n) {
  std::copy_n(from.x, n, to.x);
  std::copy_n(from.y, n, to.y);
  std::copy_n(from.z, n, to.z);
}

void count(LoopResult& sum, const LoopResult& part) {
  sum.iterations += part.iterations;
  sum.direction_updates += part.direction_updates;
  sum.visits += part.visits;
  sum.corrections += part.corrections;
}

/// Where a constraint stands, before it is known whether it takes part.
struct Reading {
  Vector n{};
  double error = 0, tolerance = 0;
  bool near = true;  // one-sided: may act at all
};

Vector direction(Vector d, double length) {
  return length > 0 ? (1 / length) * d : Vector{0, 1, 0};  // coinciding: any part them
}

Vector operator*(const Symmetric& s, Vector v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}

Symmetric inverse(const Symmetric& s) {
  const double xx = s.yy * s.zz - s.yz * s.yz, xy = s.xz * s.yz - s.xy * s.zz,
               xz = s.xy * s.yz - s.xz * s.yy;
  const double f = 1 / (s.xx * xx + s.xy * xy + s.xz * xz);
  return {f * xx, f * (s.xx * s.zz - s.xz * s.xz), f * (s.xx * s.yy - s.xy * s.xy), f * xy,
          f * xz, f * (s.xy * s.xz - s.xx * s.yz)};
}

/// Whether free particles' masses differ by so much that tensions throw the light ones about.
bool is_uneven(const Model& model) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const double w : model.inverse_mass) {
    if (w == 0) continue;
    least = std::min(least, w);
    most = std::max(most, w);
  }
  return most >= kUneven * least;
}

/// Sees the errors fall, or not.
class Progress {
 public:
  Progress(int most_solves, int patience) : most_solves_(most_solves), patience_(patience) {}
  /// Whether there still is hope, with this largest error.
  bool goes_on(double worst) {
    if (!std::isfinite(worst) || ++solves_ > most_solves_) return false;
    if (worst < 0.5 * best_) {
      best_ = worst;
      stale_ = 0;
      return true;
    }
    return ++stale_ <= patience_;
  }

 private:
  double best_ = std::numeric_limits<double>::infinity();
  int most_solves_, patience_;
  int solves_ = 0, stale_ = 0;
};

}  // namespace

DirectSolver::DirectSolver(const Model& model, const Settings& settings)
    : model_(model), layout_(model.direct()), settings_(settings), factor_(layout_) {
  const std::size_t rows = layout_.rows();
  nx_.resize(rows);
  ny_.resize(rows);
  nz_.resize(rows);
  lambda_.resize(rows);
  total_.resize(model.constraints.size());
  start_.resize(model.slots());
  uneven_ = is_uneven(model) && layout_.bodies.empty() && !model.has_contacts();
  if (uneven_) {
    g_.resize(model.slots());
    soft_.resize(model.slots());
  }
  if (model.has_contacts()) touch_of_.assign(model.slots(), kNoIndex);
  column_of_.resize(layout_.bodies.size());
  ties_.reserve(layout_.links.size());
}

// ------------------------------------------------------------------------------------ the loops

void DirectSolver::start(const ContactStore& contacts, bool first_round) {
  if (first_round) std::ranges::fill(total_, 0.0);
  total_.resize(model_.constraints.size() + contacts.count());
  if (first_round) std::ranges::fill(total_, 0.0);
}

LoopResult DirectSolver::solve_positions(VectorsView x, const ContactStore& contacts,
                                         bool first_round, int max_iterations,
                                         const Sweeps& sweeps) {
  LoopResult result;
  start(contacts, first_round);
  if (settings_.iterations > 0) {
    iterate_fixed(x, contacts, result);
    return result;
  }
  copy(x, start_.view(), start_.size());
  int wanted = kFirstSweeps;
  for (int attempt = 0;; ++attempt) {
    Outcome outcome = iterate(x, contacts, max_iterations, result);
    if (outcome == Outcome::exhausted) return result;
    if (outcome == Outcome::failed && attempt == 0 && uneven_) {
      outcome = iterate_stiff(x, contacts, max_iterations, result);
    }
    result.converged = outcome == Outcome::converged;
    if (result.converged) return result;
    copy(start_.view(), x, start_.size());
    const int left = max_iterations - result.iterations;
    if (left <= 0) return result;
    start(contacts, true);
    const LoopResult swept = sweeps(attempt == 0, std::min(wanted, left));
    count(result, swept);
    result.converged = swept.converged;
    if (result.converged || result.iterations >= max_iterations) return result;
    copy(x, start_.view(), start_.size());
    wanted = std::min(wanted, max_iterations) * kMoreSweeps;
  }
}

/// Newton's method from x.
DirectSolver::Outcome DirectSolver::iterate(VectorsView x, const ContactStore& contacts,
                                            int max_iterations, LoopResult& result) {
  Progress progress(kMostSolves, kPatience);
  const double goal = std::min(1.0, kGoal / settings_.tolerance);
  bool solved = false;
  for (;;) {
    const double worst = measure_positions(x, contacts);
    result.visits += static_cast<std::int64_t>(total_.size());
    if (worst <= kNegligible || (solved && worst <= goal)) return Outcome::converged;
    const bool enough = worst <= 1;
    if (!progress.goes_on(worst)) return enough ? Outcome::converged : Outcome::failed;
    if (result.iterations >= max_iterations) {
      return enough ? Outcome::converged : Outcome::exhausted;
    }
    solved = true;
    ++result.iterations;
    ++result.direction_updates;
    if (!solve()) return Outcome::failed;
    apply(x);
    result.corrections += active_;
  }
}

DirectSolver::Outcome DirectSolver::iterate_stiff(VectorsView x, const ContactStore& contacts,
                                                  int max_iterations, LoopResult& result) {
  copy(start_.view(), x, start_.size());
  start(contacts, true);
  const int most = stiff_solves();
  for (int solves = 0;; ++solves) {
    const double worst = measure_positions(x, contacts);
    result.visits += static_cast<std::int64_t>(total_.size());
    const double imbalance = find_imbalance(x);
    if (worst <= 0.5 && imbalance <= 0.1) {
      apply_imbalance(x);
      if (measure_positions(x, contacts) <= 1) return Outcome::converged;
      find_imbalance(x);
    }
    if (!std::isfinite(worst + imbalance) || solves == most) return Outcome::failed;
    if (result.iterations >= max_iterations) return Outcome::exhausted;
    ++result.iterations;
    ++result.direction_updates;
    result.corrections += active_;
    stiffen();
    solve_stiff(x);
  }
}

/// Its imbalance first grows by orders of magnitude: patience is all there is to bound it by.
int DirectSolver::stiff_solves() const {
  const std::size_t most = kStiffWork / (layout_.column_row.size() + layout_.rows() + 1);
  return static_cast<int>(std::clamp<std::size_t>(most, 100, kMostStiffSolves));
}

/// g = M (x - x~) + J^T lambda, in g_; the largest |W g| in tolerances.
double DirectSolver::find_imbalance(VectorsView x) {
  for (std::size_t p = 0; p < model_.slots(); ++p) {
    const double w = model_.inverse_mass[p];
    g_.set(p, w > 0 ? (1 / w) * (x[p] - start_[p]) : Vector{0, 0, 0});
  }
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const std::uint32_t c = layout_.row_constraint[row];
    const Vector j = total_[c] * Vector{nx_[row], ny_[row], nz_[row]};
    g_.view().add(layout_.a[row], j);
    g_.view().add(layout_.b[row], -1 * j);
    shortest = std::min(shortest, tolerance(c));
  }
  double worst = 0;
  for (std::size_t p = 0; p < model_.slots(); ++p) {
    worst = std::max(worst, model_.inverse_mass[p] * length(g_[p]));
  }
  return worst / shortest;
}

void DirectSolver::apply_imbalance(VectorsView x) {
  for (std::size_t p = 0; p < model_.slots(); ++p) x.add(p, -model_.inverse_mass[p] * g_[p]);
}

/// W~ = (M + sum k (1 - n n^T))^-1 per particle.
void DirectSolver::stiffen() {
  for (std::size_t p = 0; p < model_.slots(); ++p) {
    const double w = model_.inverse_mass[p];
    const double m = w > 0 ? 1 / w : 0;
    soft_[p] = {m, m, m, 0, 0, 0};
  }
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const std::uint32_t c = layout_.row_constraint[row];
    const double k = 2 * std::abs(total_[c]) / model_.constraints.rest_length[c];
    const double x = nx_[row], y = ny_[row], z = nz_[row];
    for (const std::uint32_t p : {layout_.a[row], layout_.b[row]}) {
      Symmetric& s = soft_[p];
      s.xx += k * (1 - x * x);
      s.yy += k * (1 - y * y);
      s.zz += k * (1 - z * z);
      s.xy -= k * x * y;
      s.xz -= k * x * z;
      s.yz -= k * y * z;
    }
  }
  for (std::size_t p = 0; p < model_.slots(); ++p) {
    soft_[p] = model_.inverse_mass[p] > 0 ? inverse(soft_[p]) : Symmetric{};
  }
}

void DirectSolver::solve_stiff(VectorsView x) {
  const auto n = [&](std::size_t row) { return Vector{nx_[row], ny_[row], nz_[row]}; };
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const std::uint32_t a = layout_.a[row], b = layout_.b[row];
    lambda_[row] -= dot(n(row), soft_[a] * g_[a] - soft_[b] * g_[b]);
  }
  factor_.factorise([&](std::size_t k, double* y) {
    const Vector nk = n(k);
    for (std::size_t e = layout_.entry_begin[k]; e < layout_.entry_begin[k + 1]; ++e) {
      const std::uint32_t j = layout_.entry_row[e];
      const double value = dot(n(j), soft_[layout_.entry_slot[e]] * nk);
      y[j] += layout_.entry_weight[e] > 0 ? value : -value;
    }
    const double d = dot(nk, soft_[layout_.a[k]] * nk) + dot(nk, soft_[layout_.b[k]] * nk);
    return d > 0 ? d : layout_.diagonal[k];
  });
  factor_.solve(lambda_.data());
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const double impulse = clamped(layout_.row_constraint[row], lambda_[row]);
    g_.view().add(layout_.a[row], impulse * n(row));
    g_.view().add(layout_.b[row], -impulse * n(row));
  }
  for (std::size_t p = 0; p < model_.slots(); ++p) x.add(p, -1 * (soft_[p] * g_[p]));
}

DirectSolver::Outcome DirectSolver::iterate_fixed(VectorsView x, const ContactStore& contacts,
                                                  LoopResult& result) {
  while (result.iterations < settings_.iterations) {
    measure_positions(x, contacts);
    result.visits += static_cast<std::int64_t>(total_.size());
    ++result.iterations;
    ++result.direction_updates;
    if (!solve()) return Outcome::failed;
    apply(x);
    result.corrections += active_;
  }
  return Outcome::exhausted;
}

LoopResult DirectSolver::correct_velocities(VectorsView x, VectorsView v,
                                            const ContactStore& contacts, const Sweeps& sweeps) {
  LoopResult result;
  start(contacts, true);
  copy(v, start_.view(), start_.size());
  const Outcome outcome = iterate_velocities(x, v, contacts, result);
  result.converged = outcome == Outcome::converged;
  if (result.converged || settings_.iterations > 0) return result;
  copy(start_.view(), v, start_.size());
  const int left = settings_.max_iterations - result.iterations;
  if (outcome == Outcome::exhausted || left <= 0) return result;
  const LoopResult swept = sweeps(true, left);
  count(result, swept);
  result.converged = swept.converged;
  return result;
}

/// Linear: more than one solve only where the active set changes.
DirectSolver::Outcome DirectSolver::iterate_velocities(VectorsView x, VectorsView v,
                                                       const ContactStore& contacts,
                                                       LoopResult& result) {
  const bool fixed = settings_.iterations > 0;
  Progress progress(kMostSolves, kPatience);
  for (;;) {
    const double worst = measure_velocities(x, v, contacts);
    result.visits += static_cast<std::int64_t>(total_.size());
    if (!fixed && worst <= 1) return Outcome::converged;
    if (fixed && result.iterations == settings_.iterations) return Outcome::exhausted;
    if (!fixed && !progress.goes_on(worst)) return Outcome::failed;
    if (!fixed && result.iterations >= settings_.max_iterations) return Outcome::exhausted;
    ++result.iterations;
    if (!solve()) return Outcome::failed;
    apply(v);
    result.corrections += active_;
  }
}

// ------------------------------------------------------------------------------------ measuring

/// +1: a rope, whose impulses are positive; -1: a contact; 0: a bar.
int DirectSolver::side(std::uint32_t index) const {
  const ConstraintStore& s = model_.constraints;
  if (index < s.bilateral) return 0;
  return index < s.size() ? 1 : -1;
}

double DirectSolver::tolerance(std::uint32_t index) const {
  const ConstraintStore& s = model_.constraints;
  return index < s.size() ? settings_.tolerance * s.rest_length[index]
                          : settings_.contact_tolerance;
}

/// read(index, a, b, target) is the Reading of a constraint or contact.
template <class Read>
double DirectSolver::measure(const ContactStore& contacts, Read&& read) {
  const ConstraintStore& s = model_.constraints;
  double worst = 0;
  active_ = 0;
  // Whether it takes part. An error that is not a number makes the largest error infinite.
  const auto judge = [&](std::uint32_t index, const Reading& r) {
    double e = r.error;
    bool active = true, violated = true;
    if (index >= s.bilateral) {
      const double outwards = side(index) * e;
      const bool acted = total_[index] != 0;
      active = r.near && (outwards > 0 || acted);
      violated = r.near && (outwards > 0 || (acted && outwards < -r.tolerance));
    }
    active_ += active;
    if (!violated) return active;
    const double size = std::abs(e) / r.tolerance;
    worst = size <= std::numeric_limits<double>::max() ? std::max(worst, size)
                                                       : std::numeric_limits<double>::infinity();
    return active;
  };
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const std::uint32_t c = layout_.row_constraint[row];
    const Reading r = read(c, layout_.a[row], layout_.b[row], s.rest_length[c]);
    const bool active = judge(c, r);
    nx_[row] = active ? r.n.x : 0;
    ny_[row] = active ? r.n.y : 0;
    nz_[row] = active ? r.n.z : 0;
    lambda_[row] = active ? r.error : 0;
  }
  ties_.clear();
  for (const std::uint32_t c : layout_.links) {
    const Reading r = read(c, s.a[c], s.b[c], s.rest_length[c]);
    if (judge(c, r)) ties_.push_back({c, s.a[c], s.b[c], r.n, r.error});
  }
  for (const Tie& touch : touches_) touch_of_[touch.b] = kNoIndex;
  touches_.clear();
  for (std::uint32_t k = 0; k < contacts.count(); ++k) {
    const auto index = static_cast<std::uint32_t>(s.size() + k);
    const std::uint32_t a = contacts.sphere[k], b = contacts.particle[k];
    const Reading r = read(index, a, b, contacts.distance[k]);
    if (judge(index, r)) add_contact({index, a, b, r.n, r.error});
  }
  return worst;
}

/// Of two contacts at one particle the deeper one holds it; the other waits for the next round.
void DirectSolver::add_contact(const Tie& contact) {
  const std::uint32_t p = contact.b;
  if (layout_.body_of[p] != kNoIndex || model_.inverse_mass[p] == 0) {
    ties_.push_back(contact);
    return;
  }
  if (touch_of_[p] == kNoIndex) {
    touch_of_[p] = static_cast<std::uint32_t>(touches_.size());
    touches_.push_back(contact);
  } else if (contact.error < touches_[touch_of_[p]].error) {
    touches_[touch_of_[p]] = contact;
  }
}

double DirectSolver::measure_positions(VectorsView x, const ContactStore& contacts) {
  return measure(contacts,
                 [&](std::uint32_t index, std::uint32_t a, std::uint32_t b, double target) {
                   const Vector d = x[a] - x[b];
                   const double l = length(d);
                   return Reading{direction(d, l), l - target, tolerance(index)};
                 });
}

/// Ropes and contacts take part where they are taut or touch.
double DirectSolver::measure_velocities(VectorsView x, VectorsView v,
                                        const ContactStore& contacts) {
  return measure(contacts,
                 [&](std::uint32_t index, std::uint32_t a, std::uint32_t b, double target) {
                   const Vector d = x[a] - x[b];
                   const double l = length(d);
                   const Vector n = direction(d, l);
                   const bool near = side(index) * (l - target) >= -tolerance(index);
                   return Reading{n, dot(n, v[a] - v[b]), settings_.velocity_tolerance, near};
                 });
}

// -------------------------------------------------------------------------------------- solving

bool DirectSolver::solve() {
  absorb_touches();
  factorise();
  factor_.solve(lambda_.data());
  if (!choose_bodies()) return false;
  if (!bodies_.empty()) {
    fill_balance();
    if (!solve_balance()) return false;
  }
  clamp_impulses();
  return true;
}

/// Particles in contact are moved out of it: the errors that this brings.
void DirectSolver::absorb_touches() {
  for (const Tie& touch : touches_) {
    for (const std::uint32_t row : layout_.rows_at[touch.b]) {
      const double sigma = layout_.a[row] == touch.b ? 1 : -1;
      const Vector n{nx_[row], ny_[row], nz_[row]};
      lambda_[row] += sigma * touch.error * dot(n, touch.n);
    }
  }
}

void DirectSolver::factorise() {
  const auto n = [&](std::size_t row) { return Vector{nx_[row], ny_[row], nz_[row]}; };
  if (touches_.empty()) {
    factor_.factorise([&](std::size_t k, double* y) {
      const Vector nk = n(k);
      for (std::size_t e = layout_.entry_begin[k]; e < layout_.entry_begin[k + 1]; ++e) {
        const std::uint32_t j = layout_.entry_row[e];
        y[j] += layout_.entry_weight[e] * dot(nk, n(j));
      }
      return layout_.diagonal[k];
    });
    return;
  }
  const auto along = [&](std::uint32_t p, Vector v) {
    return touch_of_[p] == kNoIndex ? 0 : dot(v, touches_[touch_of_[p]].n);
  };
  factor_.factorise([&](std::size_t k, double* y) {
    const Vector nk = n(k);
    for (std::size_t e = layout_.entry_begin[k]; e < layout_.entry_begin[k + 1]; ++e) {
      const std::uint32_t j = layout_.entry_row[e], p = layout_.entry_slot[e];
      y[j] += layout_.entry_weight[e] * (dot(nk, n(j)) - along(p, nk) * along(p, n(j)));
    }
    const double at_a = along(layout_.a[k], nk), at_b = along(layout_.b[k], nk);
    return layout_.diagonal[k] - model_.inverse_mass[layout_.a[k]] * at_a * at_a -
           model_.inverse_mass[layout_.b[k]] * at_b * at_b;
  });
}

/// The bodies that something acts on. false: too many for this method.
bool DirectSolver::choose_bodies() {
  bodies_.clear();
  if (layout_.bodies.empty()) return true;
  std::ranges::fill(column_of_, kNoIndex);
  const auto add = [&](std::uint32_t slot) {
    const std::uint32_t body = layout_.body_of[slot];
    if (body == kNoIndex || column_of_[body] != kNoIndex) return;
    column_of_[body] = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back(slot);
  };
  for (const std::uint32_t slot : layout_.bodies) {
    if (!layout_.rows_at[slot].empty()) add(slot);
  }
  for (const Tie& tie : ties_) {
    add(tie.a);
    add(tie.b);
  }
  for (const Tie& touch : touches_) add(touch.a);
  return bodies_.size() <= kMostBodies;
}

/// B of one body: how the errors change with its motion.
void DirectSolver::fill_column(std::size_t body) {
  const std::size_t rows = layout_.rows();
  double* const column = columns_.data() + 3 * body * rows;
  const auto add = [&](std::size_t row, Vector v) {
    column[row] += v.x;
    column[row + rows] += v.y;
    column[row + 2 * rows] += v.z;
  };
  const auto end = [&](std::size_t row, std::uint32_t p, Vector v) {
    return (layout_.a[row] == p ? 1 : -1) * v;
  };
  const auto n = [&](std::size_t row) { return Vector{nx_[row], ny_[row], nz_[row]}; };
  std::fill_n(column, 3 * rows, 0.0);
  for (const std::uint32_t row : layout_.rows_at[bodies_[body]]) {
    add(row, end(row, bodies_[body], n(row)));
  }
  for (const Tie& touch : touches_) {
    if (touch.a != bodies_[body]) continue;
    for (const std::uint32_t row : layout_.rows_at[touch.b]) {
      add(row, end(row, touch.b, dot(n(row), touch.n) * touch.n));
    }
  }
}

/// (W^-1 + B^T A^-1 B + contacts) y = -B^T A^-1 e - contacts, lambda_ being A^-1 e.
void DirectSolver::fill_balance() {
  const std::size_t rows = layout_.rows(), size = 3 * bodies_.size();
  columns_.resize(std::max(columns_.size(), size * rows));
  solved_.resize(std::max(solved_.size(), size * rows));
  for (std::size_t body = 0; body < bodies_.size(); ++body) fill_column(body);
  std::copy_n(columns_.data(), size * rows, solved_.data());
  for (std::size_t i = 0; i < size; ++i) factor_.solve(solved_.data() + i * rows);
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
    balance_[i * size + i] += 1 / model_.inverse_mass[bodies_[i / 3]];
    motion_[i] = -product(column, lambda_.data());
  }
  balance_touches(size);
  balance_ties(size);
}

/// A sphere in contact carries the inertia of the particle along n.
void DirectSolver::balance_touches(std::size_t size) {
  for (const Tie& touch : touches_) {
    const std::uint32_t body = layout_.body_of[touch.a];
    if (body == kNoIndex) continue;
    const std::size_t first = 3 * std::size_t{column_of_[body]};
    const double n[3] = {touch.n.x, touch.n.y, touch.n.z};
    const double mass = 1 / model_.inverse_mass[touch.b];
    for (std::size_t i = 0; i < 3; ++i) {
      motion_[first + i] -= mass * touch.error * n[i];
      for (std::size_t j = 0; j <= i; ++j) {
        balance_[(first + i) * size + first + j] += mass * n[i] * n[j];
      }
    }
  }
}

/// A link between bodies: its impulse is error / shift, the error being e + n . (y_a - y_b).
void DirectSolver::balance_ties(std::size_t size) {
  for (const Tie& tie : ties_) {
    std::size_t place[6];
    double n[6];
    std::size_t used = 0;
    const auto add = [&](std::uint32_t slot, double sigma) {
      const std::uint32_t body = layout_.body_of[slot];
      if (body == kNoIndex) return;
      for (std::size_t i = 0; i < 3; ++i) place[used + i] = 3 * std::size_t{column_of_[body]} + i;
      n[used] = sigma * tie.n.x;
      n[used + 1] = sigma * tie.n.y;
      n[used + 2] = sigma * tie.n.z;
      used += 3;
    };
    add(tie.a, 1);
    add(tie.b, -1);
    const double stiffness =
        1 / (kLinkShift * (model_.inverse_mass[tie.a] + model_.inverse_mass[tie.b]));
    for (std::size_t i = 0; i < used; ++i) {
      motion_[place[i]] -= stiffness * tie.error * n[i];
      for (std::size_t j = 0; j < used; ++j) {
        if (place[j] > place[i]) continue;
        balance_[place[i] * size + place[j]] += stiffness * n[i] * n[j];
      }
    }
  }
}

/// Cholesky, in place; then the impulses of the rows with the bodies' motion.
bool DirectSolver::solve_balance() {
  const std::size_t size = 3 * bodies_.size(), rows = layout_.rows();
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
  for (std::size_t i = 0; i < size; ++i) {
    const double* const column = solved_.data() + i * rows;
    for (std::size_t row = 0; row < rows; ++row) lambda_[row] += y[i] * column[row];
  }
  return true;
}

Vector DirectSolver::motion_of(std::uint32_t slot) const {
  const std::uint32_t body = layout_.body_of[slot];
  if (body == kNoIndex) return {0, 0, 0};
  const double* const y = motion_.data() + 3 * std::size_t{column_of_[body]};
  return {y[0], y[1], y[2]};
}

/// The part of an impulse that keeps the sum on its side of 0.
double DirectSolver::clamped(std::uint32_t index, double impulse) {
  const int s = side(index);
  const double allowed = s == 0 ? impulse : s * std::max(s * impulse, -s * total_[index]);
  total_[index] += allowed;
  return allowed;
}

/// A contact's impulse is what its particle, moved by its rows, lacks to move with the sphere.
void DirectSolver::clamp_impulses() {
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    lambda_[row] = clamped(layout_.row_constraint[row], lambda_[row]);
  }
  for (Tie& tie : ties_) {
    const double error = tie.error + dot(tie.n, motion_of(tie.a) - motion_of(tie.b));
    const double shift = kLinkShift * (model_.inverse_mass[tie.a] + model_.inverse_mass[tie.b]);
    tie.impulse = clamped(tie.index, error / shift);
  }
  for (Tie& touch : touches_) {
    Vector impulse{0, 0, 0};  // on the particle, of its rows
    for (const std::uint32_t row : layout_.rows_at[touch.b]) {
      const double sigma = layout_.a[row] == touch.b ? 1 : -1;
      impulse = impulse - (sigma * lambda_[row]) * Vector{nx_[row], ny_[row], nz_[row]};
    }
    const double gap = touch.error + dot(touch.n, motion_of(touch.a));
    touch.impulse =
        clamped(touch.index, gap / model_.inverse_mass[touch.b] - dot(touch.n, impulse));
  }
}

/// u -= M^-1 J^T lambda: every impulse acts on both ends, so momentum is kept.
void DirectSolver::apply(VectorsView u) const {
  const auto pull = [&](std::uint32_t a, std::uint32_t b, Vector impulse) {
    u.add(a, -model_.inverse_mass[a] * impulse);
    u.add(b, model_.inverse_mass[b] * impulse);
  };
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    pull(layout_.a[row], layout_.b[row], lambda_[row] * Vector{nx_[row], ny_[row], nz_[row]});
  }
  for (const Tie& tie : ties_) pull(tie.a, tie.b, tie.impulse * tie.n);
  for (const Tie& touch : touches_) pull(touch.a, touch.b, touch.impulse * touch.n);
}

std::size_t DirectSolver::bytes() const {
  return factor_.bytes() + bytes_of(nx_) + bytes_of(ny_) + bytes_of(nz_) + bytes_of(lambda_) +
         bytes_of(total_) + start_.bytes() + g_.bytes() + bytes_of(soft_) + bytes_of(touches_) +
         bytes_of(touch_of_) + bytes_of(ties_) + bytes_of(bodies_) + bytes_of(column_of_) +
         bytes_of(columns_) + bytes_of(solved_) + bytes_of(balance_) + bytes_of(motion_);
}

}  // namespace weft
