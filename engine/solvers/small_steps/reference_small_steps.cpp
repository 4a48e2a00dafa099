#include "engine/solvers/small_steps/reference_small_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/body_layout.h"
#include "engine/solvers/small_steps/reference_points.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

ReferenceSmallSteps::Points ReferenceSmallSteps::points(bool with_limits) {
  return {.x = x_.view(),
          .predicted = predicted_.view(),
          .start = before_.view(),
          .touched = touched_,
          .multipliers = multiplier_,
          .v = v_.view(),
          .rate = last_ > 0 ? 1 / last_ : 0,
          .anchor_at = with_limits && !at_limit_.empty() ? model_.anchors.at.data() : nullptr,
          .anchors = anchors_,
          .of_membrane = membrane_multiplier_,
          .bodies = with_limits && !bodies_.empty() ? &bodies_ : nullptr,
          .arrived = arrived_,
          .led_to = is_aside_ ? aside_.view() : x_.view()};
}

LawStep ReferenceSmallSteps::law_step() const {
  if (projects_) return {{1 / (h_ * h_), 0}, softest_};
  return {{1 / formula_.give(h_), model_.damping.stretch / h_}};
}

double ReferenceSmallSteps::law_error() {
  Points points = this->points(false);
  double most = largest_violation(model_.membrane, points, law_step());
  if (model_.constraints.has_springs())
    most = std::max(most, largest_violation(model_.constraints, points, law_step()));
  return most;
}

ReferenceSmallSteps::ReferenceSmallSteps(const Model& model, const Settings& settings,
                                         const simd::Table& table)
    : model_(model),
      layout_(model.small_steps()),
      settings_(settings),
      passes_(model, layout_.items),
      seams_(model),
      has_attached_(model.has_attached()),
      paces_(paces_of(layout_.bending, model.damping.bending)),
      anchors_(model.anchors),
      bodies_(model, table),
      shortest_(shortest_lengths(model)),
      at_limit_(model.anchors.size()),
      at_limit_before_(model.anchors.size()) {
  for (auto* vectors : {&x_, &before_, &predicted_, &v_, &v_before_, &acceleration_, &past_.v,
                        &past_.v_before, &past_.moved}) {
    vectors->resize(model.slots());
  }
  past_.at_limit = at_limit_;
  if (model.constraints.has_springs()) multiplier_.resize(model.constraints.size());
  membrane_multiplier_.resize(model.membrane.size());
  if (model.has_laws()) aside_.resize(model.slots());
}

reference::Flight ReferenceSmallSteps::flight() {
  return {x_.view(), before_.view(), predicted_.view(), v_.view(), v_before_.view()};
}

void ReferenceSmallSteps::begin(kernels::VectorsView x, kernels::VectorsView v, Vector gravity,
                                kernels::VectorsView force, const FramePlan& plan, Team& team) {
  const double h = plan.h;
  h_ = h;
  omega_ = plan.omega;
  projects_ = plan.projects;
  softest_ = plan.softest;
  is_begun_ = is_aside_ = false;
  passes_.forget();
  seams_.begin(plan.seams, plan.projects ? 0 : plan.h);
  departures_.begin();
  for (BendingPace& pace : paces_) pace.begin(plan);
  touched_.clear();
  arrived_.clear();
  has_past_ = !plan.placed && h <= SubstepFormula::kLargestRatio * past_.h;
  anchors_.begin(plan.anchors, h, plan.substeps);
  begin_bodies(plan);
  at_limit_.assign(at_limit_.size(), false);
  if (has_past_ && !plan.anchors.moving) at_limit_ = past_.at_limit;
  last_ = 0;
  const double push = h * decaying_share();
  accelerate(gravity, force);
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector a = acceleration_[i];
    x_.set(i, x[i]);
    v_.set(i, v[i]);
    if (!has_past_) {
      v_before_.set(i, v[i] - push * a);
      before_.set(i, x[i] - h * v[i] + (0.5 * h * h) * a);
      continue;
    }
    const Vector jump = v[i] - past_.v[i];
    v_before_.set(i, past_.v_before[i] + jump);
    before_.set(i, x[i] - (past_.moved[i] + past_.h * jump));
  }
  if (projects_) advance_bodies(1, team);
  next_formula_ = formula_after(has_past_ ? past_.h : h);
}

void ReferenceSmallSteps::accelerate(Vector gravity, kernels::VectorsView force) {
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const double w = model_.inverse_mass[i];
    const Vector pull = force.x != nullptr ? gravity + w * force[i] : gravity;
    acceleration_.set(i, w == 0 ? Vector{0, 0, 0} : pull);
  }
}

/// Of the last substep, if there was one.
void ReferenceSmallSteps::measure_departure() {
  if (last_ == 0) return;
  double largest = 0;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector a = formula_.share * acceleration_[i];
    const Vector d = reference::departure(flight(), i, a, formula_.slope, last_);
    largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  departures_.add(largest, formula_.error_share);
}

void ReferenceSmallSteps::advance(Team& team) {
  end_contacts(team);
  take_past_along();
  end_motions();
  if (settings_.motion_tolerance > 0) measure_departure();
  is_begun_ = false;
  formula_ = std::exchange(next_formula_, formula_after(h_));
  if (formula_.left < 1) decay();
  const double bh = formula_.part * h_;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    reference::advance(flight(), i, acceleration_[i], formula_.past, bh, bh * formula_.share,
                       last_);
  }
  last_ = bh;
  bend();
  anchors_.advance();
  advance_bodies(formula_.part, team);
  at_limit_before_.swap(at_limit_);
  at_limit_.assign(at_limit_.size(), false);
  if (has_attached_) hold_anchors();
}

SubstepFormula ReferenceSmallSteps::formula_after(double h_before) const {
  return SubstepFormula::of(settings_.scheme, h_ / h_before)
      .with_decay(model_.damping.motion, h_, h_before);
}

/// Of h, in which accelerations act in a flight.
double ReferenceSmallSteps::decaying_share() const {
  return SubstepFormula{}.with_decay(model_.damping.motion, h_, h_).share;
}

/// Of all velocities but those of pins.
void ReferenceSmallSteps::decay() {
  settle_velocities();
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (!is_free(i)) continue;
    v_.set(i, formula_.left * v_[i]);
    v_before_.set(i, formula_.left * v_before_[i]);
  }
}

void ReferenceSmallSteps::bend() {
  const BendingLayout& layout = layout_.bending;
  for (std::size_t k = 0; k < paces_.size(); ++k) {
    const int n = paces_[k].next();
    if (n == 0) continue;
    const reference::BendingVisit visit = paces_[k].visit(n, formula_.give(h_));
    const BendingClass& c = layout.classes[k];
    for (std::uint32_t lane = layout.first_lane(c); lane < layout.last_lane(c); ++lane) {
      const std::uint32_t i = layout.element[lane];
      if (i == kNoIndex) continue;
      reference::bend(element(i), visit, model_.inverse_mass.data(), x_.view(), v_before_.view());
    }
  }
}

double ReferenceSmallSteps::bending_energy(double give, Team&) {
  if (paces_.empty()) return 0;
  const double resolved = paces_.front().resolved(give);
  double sum = 0;
  for (const std::uint32_t i : layout_.bending.element) {
    if (i == kNoIndex) continue;
    sum += reference::energy(element(i), resolved, model_.inverse_mass.data(), x_.view());
  }
  return sum;
}

void ReferenceSmallSteps::mend(double to, Team& team) {
  if (model_.has_laws()) set_aside();
  mends_to_ = to;
  mends_ = true;
  sweep(team);
  mends_ = false;
}

/// Of l^2 / rest^2 - 1.
double ReferenceSmallSteps::left_by_sweep() const {
  const double strain = mends_to_ * settings_.tolerance;
  return mends_ ? strain * (2 + strain) : 0;
}

void ReferenceSmallSteps::set_aside() {
  if (std::exchange(is_aside_, true)) return;
  aside_ = x_;
}

void ReferenceSmallSteps::take_past_along() {
  if (!std::exchange(is_aside_, false)) return;
  for (const std::uint32_t slot : touched_) aside_.set(slot, x_[slot]);
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector by = x_[i] - aside_[i];
    predicted_.view().add(i, by);
    before_.view().add(i, by);
  }
}

void ReferenceSmallSteps::sweep(Team& team) {
  out_.clear();
  for (std::size_t family = 0; family < layout_.yarns.families(); ++family) {
    for_each_yarn(layout_.yarns, family, [&](std::span<const std::uint32_t> links) {
      relax_chain(slots_of(model_.constraints, links), links);
    });
    hold_anchors();
  }
  for (const std::uint32_t c : layout_.constraint) {
    if (c != kNoIndex) relax_edge(c);
  }
  for (const std::uint32_t c : layout_.serial) relax_edge(c);
  relax_membrane();
  if (layout_.has_single_constraints() || !layout_.has_yarns()) hold_anchors();
  draw_seams();
  hold_bodies(team);
  is_begun_ = true;
}

void ReferenceSmallSteps::judge(Team&) {
  if (model_.constraints.has_springs()) judge_springs();
  judge_membrane();
}

void ReferenceSmallSteps::judge_springs() {
  const Points points = this->points(false);
  const double tolerance = tuning::kLocalShare * settings_.tolerance;
  for (std::uint32_t c = 0; c < model_.constraints.size(); ++c) {
    if (breaks_law(model_.constraints, points, law_step(), tolerance, c)) out_.push_back(c);
  }
}

void ReferenceSmallSteps::relax_chain(std::span<const std::uint32_t> slots,
                                      std::span<const std::uint32_t> links) {
  if (model_.constraints.has_springs()) return relax_spring_chain(slots, links);
  reference::ChainSystem& system = system_;
  system.clear();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    system.w.push_back(model_.inverse_mass[slots[k]]);
    if (k == links.size()) break;
    const Vector d = x_[slots[k]] - x_[slots[k + 1]];
    const double rest = model_.constraints.rest_length[links[k]];
    if (std::abs(length(d) - rest) > tuning::kLocalShare * settings_.tolerance * rest)
      out_.push_back(links[k]);
    system.d.push_back(d);
    system.error.push_back(
        0.5 * reference::beyond(dot(d, d) - rest * rest, left_by_sweep() * rest * rest));
  }
  system.solve(mends_ ? 1 : omega_, compliance_of_yarn(model_, slots));
  apply_impulses(slots);
}

/// Each law divided by 1 + damping, which leaves the matrix symmetric.
void ReferenceSmallSteps::relax_spring_chain(std::span<const std::uint32_t> slots,
                                             std::span<const std::uint32_t> links) {
  const ConstraintStore& s = model_.constraints;
  const LawStep step = law_step();
  Points points = this->points(false);
  reference::ChainSystem& system = system_;
  system.clear();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    system.w.push_back(model_.inverse_mass[slots[k]]);
    if (k == links.size()) break;
    if (!is_begun_) points.set_multiplier(links[k], 0);
    const Vector d = x_[slots[k]] - x_[slots[k + 1]];
    const LawVisit visit = visit_law(s, points, step.springs, links[k]);
    const double share = 1 / (1 + visit.law.damping);
    system.d.push_back(d);
    system.error.push_back(share * visit.length * visit.residual);
    system.softness.push_back(share * visit.law.softness);
    system.is_left.push_back(!step.is_kept(s, links[k]));
  }
  system.solve(omega_, compliance_of_yarn(model_, slots));
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double impulse = system.error[k] * length(system.d[k]);
    points.set_multiplier(links[k], points.multiplier(links[k]) + impulse);
  }
  apply_impulses(slots);
}

/// Those that the system was solved for.
void ReferenceSmallSteps::apply_impulses(std::span<const std::uint32_t> slots) {
  const reference::ChainSystem& system = system_;
  for (std::size_t k = 0; k < system.d.size(); ++k) {
    const Vector impulse = system.error[k] * system.d[k];
    x_.view().add(slots[k], -system.w[k] * impulse);
    x_.view().add(slots[k + 1], system.w[k + 1] * impulse);
  }
}

void ReferenceSmallSteps::relax_edge(std::uint32_t c) {
  const ConstraintStore& s = model_.constraints;
  if (s.has_springs()) return relax_spring(c);
  const std::uint32_t a = s.a[c], b = s.b[c];
  const Vector d = x_[a] - x_[b];
  const double rest = s.rest_length[c], error = length(d) - rest;
  const bool rope = c >= s.bilateral;
  if ((rope ? error : std::abs(error)) > tuning::kLocalShare * settings_.tolerance * rest)
    out_.push_back(c);
  if (rope && error <= 0) return;
  const double impulse = reference::relaxed_impulse(d, rest, 1 / s.effective_mass[c],
                                                    mends_ ? 1 : omega_, left_by_sweep());
  x_.view().add(a, (-model_.inverse_mass[a] * impulse) * d);
  x_.view().add(b, (model_.inverse_mass[b] * impulse) * d);
}

void ReferenceSmallSteps::relax_spring(std::uint32_t c) {
  Points points = this->points(false);
  sweep_law(model_, points, law_step(), !is_begun_, omega_, c);
}

void ReferenceSmallSteps::relax_membrane() {
  if (law_step().leaves_triangles()) return;
  Points points = this->points(false);
  if (!is_begun_) std::ranges::fill(membrane_multiplier_, reference::MembraneMultipliers{});
  for (const std::uint32_t i : layout_.membrane.element) {
    if (i != kNoIndex) relax_element(model_, points, law_step(), omega_, i);
  }
}

void ReferenceSmallSteps::judge_membrane() {
  const Points points = this->points(false);
  const double tolerance = tuning::kLocalShare * settings_.tolerance;
  for (std::uint32_t i = 0; i < model_.membrane.size(); ++i) {
    if (violation_of_element(model_.membrane, points, law_step(), i) > tolerance)
      out_.push_back(passes_.item_of_element(i));
  }
}

void ReferenceSmallSteps::draw_seams() {
  if (seams_.empty()) return;
  Points points = this->points(false);
  seams_.draw(points, 1 / law_step().springs.scale, !is_begun_);
}

void ReferenceSmallSteps::end_seams() {
  if (seams_.empty()) return;
  seams_.end_substep(this->points(false), 1 / law_step().springs.scale, settings_.contact_tolerance,
                     [&](std::uint32_t a, std::uint32_t b) {
                       touched_.push_back(a);
                       touched_.push_back(b);
                     });
}

LocalWork ReferenceSmallSteps::run_passes(const SphereContacts& contacts, std::int64_t most_visits,
                                          Team& team) {
  if (model_.has_laws()) set_aside();
  Points points = this->points(true);
  const LocalLimits limits{.tolerance = tuning::kLocalShare * settings_.tolerance,
                           .contact_tolerance = tuning::kLocalShare * settings_.contact_tolerance,
                           .mended = tuning::kMended * settings_.tolerance,
                           .most_visits = most_visits,
                           .laws = law_step()};
  const LocalWork work = passes_.run(points, contacts, limits);
  draw_seams();
  hold_by_meshes(team);
  return work;
}

LocalWork ReferenceSmallSteps::repair(const SphereContacts& contacts, std::int64_t most_visits,
                                      Team& team) {
  for (const std::uint32_t item : out_) passes_.look_near(item);
  return run_passes(contacts, most_visits, team);
}

LocalWork ReferenceSmallSteps::repair_everywhere(const SphereContacts& contacts,
                                                 std::int64_t most_visits, Team& team) {
  passes_.look_everywhere();
  return run_passes(contacts, most_visits, team);
}

void ReferenceSmallSteps::read_positions_of(std::span<const std::uint32_t> slots,
                                            kernels::VectorsView x) const {
  for (const std::uint32_t slot : slots) x.set(slot, x_[slot]);
}

void ReferenceSmallSteps::read_starts(kernels::VectorsView x, Team&) const {
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) x.set(slot, before_[slot]);
}

double ReferenceSmallSteps::largest_move(Team&) {
  double most = 0;
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot)
    most = std::max(most, length(x_[slot] - before_[slot]));
  return most;
}

void ReferenceSmallSteps::read_positions(kernels::VectorsView x, Team&) const {
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (is_free(i)) x.set(i, x_[i]);
  }
}

void ReferenceSmallSteps::settle(Team&) {
  take_past_along();
  end_motions();
  measure_departure();
  settle_velocities();
}

void ReferenceSmallSteps::settle_velocities() {
  for (std::size_t i = 0; i < model_.slots(); ++i) reference::settle(flight(), i, last_);
  last_ = 0;
}

void ReferenceSmallSteps::read_velocities(kernels::VectorsView v, Team&) const {
  for (std::size_t i = 0; i < model_.slots(); ++i) v.set(i, v_[i]);
}

void ReferenceSmallSteps::keep(Team&) {
  past_.h = h_;
  past_.v = v_;
  past_.v_before = v_before_;
  past_.at_limit = at_limit_;
  past_.touching = bodies_.touching();
  past_.misplaced = bodies_.meshes().misplaced();
  for (std::size_t i = 0; i < model_.slots(); ++i) past_.moved.set(i, x_[i] - before_[i]);
}

std::size_t ReferenceSmallSteps::bytes() const {
  return 9 * x_.bytes() + bytes_of(out_) + bytes_of(touched_) + bytes_of(arrived_) +
         bytes_of(multiplier_) + bytes_of(membrane_multiplier_) + aside_.bytes() + passes_.bytes() +
         seams_.bytes();
}

}  // namespace weft
