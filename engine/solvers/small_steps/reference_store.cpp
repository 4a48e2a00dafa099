#include "engine/solvers/small_steps/reference_store.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/change.h"
#include "engine/solvers/small_steps/body_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

ReferenceStore::ReferenceStore(Substep& now, const simd::Table& table)
    : now_(now),
      model_(now.model),
      layout_(model_.small_steps()),
      bending_frame_(model_, now.settings),
      bending_(layout_.bending.rows, table),
      anchors_(model_.anchors),
      bodies_(model_, table),
      shortest_(shortest_lengths(model_)),
      at_limit_(model_.anchors.size()),
      at_limit_before_(model_.anchors.size()) {
  for (auto* vectors : {&x_, &before_, &predicted_, &v_, &v_before_, &acceleration_, &from_,
                        &past_.v, &past_.v_before, &past_.moved}) {
    vectors->resize(model_.slots());
  }
  past_.at_limit = at_limit_;
  if (!layout_.bending.empty()) bending_.allocate();
  if (model_.constraints.has_springs()) multiplier_.resize(model_.constraints.size());
  membrane_multiplier_.resize(model_.membrane.size());
  if (model_.has_laws()) aside_.resize(model_.slots());
}

ReferenceStore::Points ReferenceStore::points(bool with_limits) {
  return {.x = x_.view(),
          .predicted = predicted_.view(),
          .start = before_.view(),
          .touched = now_.touched,
          .multipliers = multiplier_,
          .v = v_.view(),
          .rate = last_ > 0 ? 1 / last_ : 0,
          .anchor_at = with_limits && !at_limit_.empty() ? model_.anchors.at.data() : nullptr,
          .anchors = anchors_,
          .of_membrane = membrane_multiplier_,
          .bodies = with_limits && !bodies_.empty() ? &bodies_ : nullptr,
          .arrived = now_.arrived,
          .velocity_jumps = now_.velocity_jumps,
          .led_to = now_.is_aside ? aside_.view() : x_.view()};
}

reference::Flight ReferenceStore::flight() {
  return {x_.view(), before_.view(), predicted_.view(), v_.view(), v_before_.view()};
}

void ReferenceStore::begin(kernels::VectorsView x, kernels::VectorsView v, const FramePlan& plan,
                           Team&) {
  anchors_.begin(plan.anchors, plan.dt_substep, plan.substeps);
  at_limit_.assign(at_limit_.size(), false);
  if (now_.has_past && !plan.anchors.moving) at_limit_ = past_.at_limit;
  last_ = 0;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    x_.set(i, x[i]);
    v_.set(i, v[i]);
  }
}

void ReferenceStore::accelerate(Vector gravity, kernels::VectorsView force) {
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const double w = model_.inverse_mass[i];
    const Vector pull = force.x != nullptr ? gravity + w * force[i] : gravity;
    acceleration_.set(i, w == 0 ? Vector{0, 0, 0} : pull);
  }
}

/// Without a past the particles are taken to have been in free flight.
void ReferenceStore::begin_past(Team&) {
  const double h = now_.dt_substep, push = h * now_.decaying_share();
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector a = acceleration_[i];
    if (!now_.has_past) {
      v_before_.set(i, v_[i] - push * a);
      before_.set(i, x_[i] - h * v_[i] + (0.5 * h * h) * a);
      continue;
    }
    const Vector jump = v_[i] - past_.v[i];
    v_before_.set(i, past_.v_before[i] + jump);
    before_.set(i, x_[i] - (past_.moved[i] + past_.dt_substep * jump));
  }
}

/// The departure of the last substep, if velocities are not settled yet.
std::optional<double> ReferenceStore::departure() {
  if (last_ == 0) return {};
  double largest = 0;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector a = now_.formula.share * acceleration_[i];
    const Vector d = reference::departure(flight(), i, a, now_.formula.slope, last_);
    largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  return largest;
}

std::optional<double> ReferenceStore::predict(Team&) {
  const auto largest = now_.measures_departures() ? departure() : std::nullopt;
  const SubstepFormula& formula = now_.next_formula;
  const double bh = formula.part * now_.dt_substep;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    reference::advance(flight(), i, acceleration_[i], formula.past, bh, bh * formula.share, last_);
  }
  last_ = bh;
  return largest;
}

/// The decay of all velocities but those of pins.
void ReferenceStore::decay(double to, Team&) {
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (!now_.is_free(i)) continue;
    v_.set(i, to * v_[i]);
    v_before_.set(i, to * v_before_[i]);
  }
}

void ReferenceStore::take_past_along(Team&) {
  for (const std::uint32_t slot : now_.touched) aside_.set(slot, x_[slot]);
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const Vector by = x_[i] - aside_[i];
    predicted_.view().add(i, by);
    before_.view().add(i, by);
  }
}

void ReferenceStore::judge_springs(Team&) {
  const Points points = this->points(false);
  const double tolerance = now_.local_tolerance();
  for (std::uint32_t c = 0; c < model_.constraints.size(); ++c)
    if (violation_of_law(model_.constraints, points, now_.law_step(), c) > tolerance)
      out_.push_back(c);
}

void ReferenceStore::relax_chain(std::span<const std::uint32_t> slots,
                                 std::span<const std::uint32_t> links, const Relaxation& by) {
  if (model_.constraints.has_springs()) return relax_spring_chain(slots, links);
  reference::ChainSystem& system = system_;
  system.clear();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    system.w.push_back(model_.inverse_mass[slots[k]]);
    if (k == links.size()) break;
    const Vector d = x_[slots[k]] - x_[slots[k + 1]];
    const double rest = model_.constraints.rest_length[links[k]];
    if (std::abs(length(d) - rest) > now_.local_tolerance() * rest) out_.push_back(links[k]);
    system.d.push_back(d);
    system.error.push_back(0.5 *
                           reference::beyond(dot(d, d) - rest * rest,
                                             reference::squared_strain(by.left) * rest * rest));
  }
  system.solve(by.omega, compliance_of_yarn(model_, slots));
  apply_impulses(slots);
}

/// Each law divided by 1 + damping, which leaves the matrix symmetric.
void ReferenceStore::relax_spring_chain(std::span<const std::uint32_t> slots,
                                        std::span<const std::uint32_t> links) {
  const ConstraintStore& s = model_.constraints;
  const LawStep step = now_.law_step();
  Points points = this->points(false);
  reference::ChainSystem& system = system_;
  system.clear();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    system.w.push_back(model_.inverse_mass[slots[k]]);
    if (k == links.size()) break;
    if (!now_.is_begun) points.set_multiplier(links[k], 0);
    const Vector d = x_[slots[k]] - x_[slots[k + 1]];
    const LawVisit visit = visit_law(s, points, step.springs, links[k]);
    const double share = 1 / (1 + visit.law.damping);
    system.d.push_back(d);
    system.error.push_back(share * visit.length * visit.residual);
    system.softness.push_back(share * visit.law.softness);
    system.is_left.push_back(!step.is_kept(s, links[k]));
  }
  system.solve(now_.omega, compliance_of_yarn(model_, slots));
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double impulse = system.error[k] * length(system.d[k]);
    points.set_multiplier(links[k], points.multiplier(links[k]) + impulse);
  }
  apply_impulses(slots);
}

/// Those that the system was solved for.
void ReferenceStore::apply_impulses(std::span<const std::uint32_t> slots) {
  const reference::ChainSystem& system = system_;
  for (std::size_t k = 0; k < system.d.size(); ++k) {
    const Vector impulse = system.error[k] * system.d[k];
    x_.view().add(slots[k], -system.w[k] * impulse);
    x_.view().add(slots[k + 1], system.w[k + 1] * impulse);
  }
}

void ReferenceStore::relax_edge(std::uint32_t c, const Relaxation& by) {
  const ConstraintStore& s = model_.constraints;
  if (s.has_springs()) return relax_spring(c);
  const std::uint32_t a = s.a[c], b = s.b[c];
  const Vector d = x_[a] - x_[b];
  const double rest = s.rest_length[c], error = length(d) - rest;
  const bool rope = c >= s.bilateral;
  if ((rope ? error : std::abs(error)) > now_.local_tolerance() * rest) out_.push_back(c);
  if (rope && error <= 0) return;
  const double impulse = reference::relaxed_impulse(d, rest, 1 / s.effective_mass[c], by.omega,
                                                    reference::squared_strain(by.left));
  x_.view().add(a, (-model_.inverse_mass[a] * impulse) * d);
  x_.view().add(b, (model_.inverse_mass[b] * impulse) * d);
}

void ReferenceStore::relax_spring(std::uint32_t c) {
  Points points = this->points(false);
  sweep_law(model_, points, now_.law_step(), !now_.is_begun, now_.omega, c);
}

void ReferenceStore::sweep_membrane(Team&) {
  if (now_.law_step().leaves_triangles()) return;
  Points points = this->points(false);
  if (!now_.is_begun) std::ranges::fill(membrane_multiplier_, reference::MembraneMultipliers{});
  for (const std::uint32_t i : layout_.membrane.element) {
    if (i != kNoIndex) relax_element(model_, points, now_.law_step(), now_.omega, i);
  }
}

void ReferenceStore::judge_membrane(Team&) {
  const Points points = this->points(false);
  const double tolerance = now_.local_tolerance();
  for (std::uint32_t i = 0; i < model_.membrane.size(); ++i) {
    if (violation_of_element(model_.membrane, points, now_.law_step(), i) > tolerance)
      out_.push_back(now_.passes.item_of_element(i));
  }
}

void ReferenceStore::read_positions_of(std::span<const std::uint32_t> slots,
                                       kernels::VectorsView x) const {
  for (const std::uint32_t slot : slots) x.set(slot, x_[slot]);
}

void ReferenceStore::read_starts(kernels::VectorsView x, Team&) const {
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) x.set(slot, before_[slot]);
}

double ReferenceStore::largest_move(Team&) {
  double most = 0;
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot)
    most = std::max(most, length(x_[slot] - before_[slot]));
  return most;
}

void ReferenceStore::read_positions(kernels::VectorsView x, Team&) const {
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (now_.is_free(i)) x.set(i, x_[i]);
  }
}

std::optional<double> ReferenceStore::settle(bool measures, Team&) {
  const auto largest = measures ? departure() : std::nullopt;
  for (std::size_t i = 0; i < model_.slots(); ++i) reference::settle(flight(), i, last_);
  last_ = 0;
  return largest;
}

void ReferenceStore::read_velocities(kernels::VectorsView v, Team&) const {
  for (std::size_t i = 0; i < model_.slots(); ++i) v.set(i, v_[i]);
}

void ReferenceStore::keep(Team&) {
  past_.dt_substep = now_.dt_substep;
  past_.v = v_;
  past_.v_before = v_before_;
  past_.at_limit = at_limit_;
  past_.touching = bodies_.touching();
  past_.misplaced = bodies_.meshes().misplaced();
  bodies_.remember(past_.contacts);
  for (std::size_t i = 0; i < model_.slots(); ++i) past_.moved.set(i, x_[i] - before_[i]);
}

bool ReferenceStore::Points::solve_contacts(std::uint32_t slot) const {
  const bool is_held = solve_body_contacts(slot);
  if (!bodies->has_meshes()) return is_held;
  PointParticles particles(*this);
  return bodies->meshes().solve_at(particles, bodies->clock(), slot) || is_held;
}

void ReferenceStore::hold_anchors(Team&) {
  const Points points = this->points(true);
  const double strain = now_.local_tolerance();
  for (std::uint32_t i = 0; i < at_limit_.size(); ++i) {
    const std::uint32_t slot = model_.anchors.slot[i];
    const Vector from = x_[slot];
    if (!points.hold(slot, i)) continue;
    if (!at_limit_before_[i] && !at_limit_[i]) now_.arrived.push_back({slot});
    at_limit_[i] = true;
    if (length(x_[slot] - from) > strain * layout_.anchors.shortest[i]) now_.passes.look_at(slot);
  }
}

void ReferenceStore::advance_anchors() {
  anchors_.advance();
  at_limit_before_.swap(at_limit_);
  at_limit_.assign(at_limit_.size(), false);
}

void ReferenceStore::begin_bodies(const FramePlan& plan) {
  bodies_.begin(plan.bodies, plan.dt_substep, plan.substeps, plan.projects(),
                now_.has_past && !plan.bodies_move ? past_.touching : ReferenceBodies::Touching{},
                plan.contact_start(), past_.misplaced, now_.has_past ? &past_.contacts : nullptr);
  if (bodies_.has_meshes()) at_hand_.make_room(model_.slots());
}

void ReferenceStore::advance_bodies(double part, Team& team) {
  const Points points = this->points(true);
  PointParticles particles(points);
  bodies_.advance(part, particles, team);
}

void ReferenceStore::hold_bodies(Team&) {
  const Points points = this->points(true);
  const double strain = now_.local_tolerance();
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (!now_.is_free(slot)) continue;
    const Vector from = x_[slot];
    if (points.solve_body_contacts(slot) && length(x_[slot] - from) > strain * shortest_[slot])
      now_.passes.look_at(slot);
  }
}

void ReferenceStore::hold_by_meshes(Team& team) {
  const Points points = this->points(true);
  TakenParticles particles(points, at_hand_);
  const double strain = now_.local_tolerance();
  bodies_.hold_by_meshes(particles, team, [&](std::uint32_t slot, double by) {
    if (by > strain * shortest_[slot]) now_.passes.look_at(slot);
  });
}

double ReferenceStore::deepest_in_body(Team& team) {
  const Points points = this->points(true);
  PointParticles particles(points);
  return bodies_.deepest(before_, x_, particles, team);
}

void ReferenceStore::stop_at_contact(std::uint32_t i) {
  const Vector v = (1 / now_.dt_substep) * (x_[i] - before_[i]),
               gain = now_.dt_substep * now_.decaying_share() * acceleration_[i];
  predicted_.set(i, x_[i]);
  v_.set(i, v);
  v_before_.set(i, v - gain);
  before_.set(i, x_[i] - now_.dt_substep * (v + gain));
}

void ReferenceStore::begin_at_limit(std::uint32_t i) {
  const double rate = last_ > 0 ? 1 / last_ : 0;  // settled already: what is predicted is there
  const Vector a = acceleration_[i], v = v_[i] + rate * (x_[i] - predicted_[i]);
  const Vector v_before = v - now_.dt_substep * now_.decaying_share() * a;
  predicted_.set(i, x_[i]);
  v_.set(i, v);
  v_before_.set(i, v_before);
  before_.set(i, x_[i] - now_.dt_substep * v + (0.5 * now_.dt_substep * now_.dt_substep) * a);
}

void ReferenceStore::jump_velocity(std::uint32_t i, Vector by) {
  const double rate = last_ > 0 ? 1 / last_ : 0;
  const Vector v = v_[i] + rate * (x_[i] - predicted_[i]), v_before = v_before_[i] + by;
  predicted_.set(i, x_[i]);
  v_.set(i, v);
  v_before_.set(i, v_before);
  before_.set(i, x_[i] - now_.dt_substep * v);
}

void ReferenceStore::go_on_from(const ReferenceStore& other, kernels::VectorsView v,
                                kernels::Vector gravity) {
  past_.dt_substep = other.past_.dt_substep;
  if (model_.anchors.slot == other.model_.anchors.slot)
    past_.at_limit = other.past_.at_limit;
  else
    past_.at_limit.assign(at_limit_.size(), false);
  past_.misplaced.clear();
  past_.misplaced.tangled = other.past_.misplaced.tangled;  // triangles keep their numbers
  past_.contacts = other.past_.contacts;                    // and so do edges, but in a tear
  if (model_.tears != other.model_.tears) past_.contacts.clear();
  for_each_particle(model_, other.model_, [&](std::uint32_t slot, std::uint32_t its_slot) {
    const Past& its = other.past_;
    ParticlePast past{its.v[its_slot], its.v_before[its_slot], its.moved[its_slot]};
    if (now_.is_free(slot) != other.now_.is_free(its_slot))
      past = now_.is_free(slot) ? ParticlePast::flight(v[slot], gravity, past_.dt_substep)
                                : ParticlePast{};
    past_.v.set(slot, past.v);
    past_.v_before.set(slot, past.v_before);
    past_.moved.set(slot, past.moved);
    past_.misplaced.take_over(its.misplaced, its_slot, slot);
  });
  past_.misplaced.sort();
}

bool ReferenceStore::load_past(ArchiveReader& archive) {
  Past past;
  archive(past);
  const auto has_slots = [&](const kernels::Vectors& v) { return v.size() == model_.slots(); };
  const bool is_past = has_slots(past.v) && has_slots(past.v_before) && has_slots(past.moved) &&
                       past.at_limit.size() == at_limit_.size() &&
                       are_slots(model_, past.misplaced.inside) &&
                       are_slots(model_, past.misplaced.crossing) && past.contacts.is_whole() &&
                       past.dt_substep >= 0 && std::isfinite(past.dt_substep);
  if (!archive.is_done() || !is_past) return false;
  past_ = std::move(past);
  return true;
}

void ReferenceStore::turn(const Turn& by) {
  for (kernels::Vectors* v : {&past_.v, &past_.v_before, &past_.moved}) {
    for (std::size_t i = 0; i < model_.slots(); ++i) v->set(i, by((*v)[i]));
  }
  past_.contacts.turn(by);
}

std::size_t ReferenceStore::bytes() const {
  return 10 * x_.bytes() + bending_.bytes() + bytes_of(folds_) + bytes_of(out_) +
         bytes_of(multiplier_) + bytes_of(membrane_multiplier_) + aside_.bytes() + at_hand_.bytes();
}

}  // namespace weft
