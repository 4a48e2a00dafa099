#include "engine/solvers/small_steps/linkage.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/tuning.h"
#include "kernels/reference/small_steps.h"

namespace weft {
namespace {

using Axes = LinkageLayout::Places::Axes;

void add(double* values, const Axes& at, double value) {
  for (const int place : at) {
    if (place >= 0) values[place] += value;
  }
}
void set(double* values, const Axes& at, kernels::Vector v) {
  if (at[0] < 0) return;
  values[at[0]] = v.x;
  values[at[1]] = v.y;
  values[at[2]] = v.z;
}

}  // namespace

Linkage::Linkage(const Model& model, const LinkageLayout& layout)
    : model_(model), layout_(layout), factor_(layout.matrix, layout.factor) {
  if (layout_.empty()) return;
  const std::size_t links = model.constraints.size();
  d_.resize(links);
  error_.resize(links);
  impulse_.resize(links);
  tension_.resize(links);
  is_taut_.resize(links);
  out_.reserve(links);
  arrives_.resize(model.slots());
  values_.resize(layout_.matrix.rows.size());
  solution_.resize(3 * layout_.slots.size() + links);
}

void Linkage::begin(bool continues) {
  out_.clear();
  if (!continues) std::ranges::fill(impulse_, 0);
}

void Linkage::take(std::uint32_t c, kernels::Vector d, double left, double tolerance) {
  const double rest = model_.constraints.rest_length[c], square = rest * rest;
  const double error = dot(d, d) - square, most = reference::squared_strain(tolerance) * square;
  d_[c] = d;
  error_[c] = 0.5 * reference::beyond(error, reference::squared_strain(left) * square);
  is_taut_[c] = dot(d, d) > 0 && (!is_rope(c) || error > -most);
  if ((is_rope(c) ? error : std::abs(error)) > most) out_.push_back(c);
}

/// The residual of a slack rope is its own.
void Linkage::solve_once() {
  double* values = values_.data();
  std::ranges::fill(values_, 0);
  std::ranges::fill(solution_, 0);
  for (std::size_t i = 0; i < layout_.slots.size(); ++i)
    add(values, layout_.places_of_slot[i], 1 / model_.inverse_mass[layout_.slots[i]]);
  for (std::size_t c = 0; c < d_.size(); ++c) {
    const LinkageLayout::Places& at = layout_.places[c];
    values[at.own] = -1;
    if (!is_taut_[c]) continue;
    values[at.own] =
        -tuning::kLinkageCompliance * dot(d_[c], d_[c]) / model_.constraints.effective_mass[c];
    add(values, at.of_a, tension_[c]);
    add(values, at.of_b, tension_[c]);
    add(values, at.between, -tension_[c]);
    set(values, at.with_a, d_[c]);
    set(values, at.with_b, -1.0 * d_[c]);
    solution_[static_cast<std::size_t>(layout_.row_of_link[c])] = -error_[c];
  }
  if (factor_.factorise(values_))
    factor_.solve(solution_);
  else
    std::ranges::fill(solution_, 0);
}

/// Returns whether it was found otherwise.
bool Linkage::find_taut() {
  const ConstraintStore& s = model_.constraints;
  const auto move = [&](std::uint32_t slot) {
    const int row = layout_.row_of_slot[slot];
    if (row < 0) return kernels::Vector{};
    const double* by = solution_.data() + row;
    return kernels::Vector{by[0], by[1], by[2]};
  };
  bool changes = false;
  for (std::size_t c = s.bilateral; c < s.size(); ++c) {
    const double beyond = error_[c] + dot(d_[c], move(s.a[c]) - move(s.b[c]));
    const std::uint8_t taut = is_taut_[c] ? impulse_[c] + lambda(c) > 0 : beyond > 0;
    changes |= taut != is_taut_[c];
    is_taut_[c] = taut;
  }
  return changes;
}

/// Returns the largest change as a share of the largest tension.
double Linkage::update_tension() {
  double most = 0, change = 0;
  for (std::size_t c = 0; c < d_.size(); ++c) {
    const double tension = is_taut_[c] ? std::max(0.0, impulse_[c] + lambda(c)) : 0;
    most = std::max(most, tension);
    change = std::max(change, std::abs(tension - tension_[c]));
    tension_[c] = tension;
  }
  return most > 0 ? change / most : 0;
}

void Linkage::solve() {
  for (std::size_t c = 0; c < d_.size(); ++c) tension_[c] = std::max(0.0, impulse_[c]);
  for (int round = 1;; ++round) {
    solve_once();
    const bool changes = find_taut();
    const bool settles = update_tension() <= tuning::kLinkageTension;
    if (round >= tuning::kLinkageRounds || (settles && !changes)) break;
  }
  for (std::size_t c = 0; c < d_.size(); ++c)
    impulse_[c] = is_taut_[c] ? impulse_[c] + lambda(c) : 0;
}

bool Linkage::was_slack(std::size_t rope, kernels::Vector d) const {
  const double rest = model_.constraints.rest_length[rope];
  return dot(d, d) < (1 - tuning::kLinkageSlack) * rest * rest;
}

/// Along taut links, there and back: twice over a chain that is numbered along itself.
void Linkage::spread_arrivals() {
  const ConstraintStore& s = model_.constraints;
  const auto spread = [&](std::size_t c) {
    const auto may_move = [&](std::uint32_t slot) { return model_.inverse_mass[slot] > 0; };
    if (!is_taut_[c] || !may_move(s.a[c]) || !may_move(s.b[c])) return false;
    if (arrives_[s.a[c]] == arrives_[s.b[c]]) return false;
    arrives_[s.a[c]] = arrives_[s.b[c]] = true;
    return true;
  };
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t c = 0; c < s.size(); ++c) grows |= spread(c);
    for (std::size_t c = s.size(); c-- > 0;) grows |= spread(c);
  }
}

std::size_t Linkage::bytes() const {
  return factor_.bytes() + bytes_of(values_) + bytes_of(solution_) + bytes_of(d_) +
         bytes_of(error_) + bytes_of(impulse_) + bytes_of(tension_) + bytes_of(is_taut_) +
         bytes_of(out_) + bytes_of(arrives_);
}

}  // namespace weft
