#include "engine/solvers/small_steps/simd_small_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr std::size_t kPart = 4 * kStretch;  // floats that a thread takes at a time

}  // namespace

LanePoints SmallStepsSolver::points(bool with_limits) {
  return {.places = layout_.places(),
          .base = base_.data(),
          .u = u_.data(),
          .predicted = predicted_.data(),
          .u_start = u_before_.data(),
          .touched = touched_,
          .multiplier_place = layout_.multiplier_place,
          .multipliers = links_.multipliers(),
          .v = v_.data(),
          .rate = static_cast<double>(weights_.last.rate),
          .anchor_at = with_limits && !anchors_.empty() ? model_.anchors.at.data() : nullptr,
          .anchors = anchors_.clock(),
          .membrane = membrane_,
          .bodies = with_limits && !bodies_.empty() ? &bodies_ : nullptr,
          .arrived = arrived_,
          .led_to = is_aside_ ? aside_.data() : u_.data()};
}

LawStep SmallStepsSolver::law_step() const {
  if (projects_) return {{1 / (h_ * h_), 0}, softest_};
  return {{1 / formula_.give(h_), model_.damping.stretch / h_}};
}

double SmallStepsSolver::law_error() {
  LanePoints points = this->points(false);
  double most = largest_violation(model_.membrane, points, law_step());
  if (model_.constraints.has_springs())
    most = std::max(most, largest_violation(model_.constraints, points, law_step()));
  return most;
}

SmallStepsSolver::SmallStepsSolver(const Model& model, const Settings& settings,
                                   const simd::Table& table)
    : model_(model),
      layout_(model.small_steps()),
      settings_(settings),
      table_(table),
      passes_(model, layout_.items),
      seams_(model),
      has_attached_(model.has_attached()),
      links_(model, settings, table),
      membrane_(model, table),
      bending_(model, table),
      anchors_(model, settings, table),
      bodies_(model, settings, table),
      largest_((layout_.floats + kPart - 1) / kPart) {
  for (auto* array : {&base_, &u_, &u_before_, &predicted_, &v_, &v_before_, &acceleration_}) {
    array->resize(layout_.floats);
  }
  for (auto* array : {&past_.v, &past_.v_before, &past_.moved, &past_.base})
    array->resize(layout_.floats);
  if (model.has_laws()) aside_.resize(layout_.floats);
  past_.at_limit = anchors_.at_limit();
  arrived_.reserve(model.anchors.size());
}

simd::Flight SmallStepsSolver::flight() {
  return {u_.data(),
          u_before_.data(),
          predicted_.data(),
          v_.data(),
          v_before_.data(),
          acceleration_.data(),
          is_aside_ ? aside_.data() : u_.data()};
}

template <class Work>
void SmallStepsSolver::for_floats(Team& team, Work&& work) {
  team.for_each_part(layout_.floats, kPart, work);
}

/// Of work that ends a substep, and returns the largest departure of its floats.
template <class Work>
void SmallStepsSolver::settle_floats(Team& team, Work&& work) {
  for_floats(team, [&](std::size_t first, std::size_t last) {
    largest_[first / kPart] = work(first, last);
  });
  if (weights_.last.rate != 0) departures_.add(largest_of_parts(), formula_.error_share);
}

double SmallStepsSolver::largest_of_parts() const {
  return largest_.empty() ? 0 : static_cast<double>(*std::ranges::max_element(largest_));
}

/// Lengths of constraints are rounded to 2^-24, and their corrections are velocities over h. In
/// the mean of the largest of some thousands three times that was measured.
double SmallStepsSolver::rounding_error(double h) const {
  return 3 * 0x1p-24 * layout_.load.mean_length / h;
}

/// Only where it may have changed.
void SmallStepsSolver::write_acceleration(kernels::Vector gravity, kernels::VectorsView force) {
  const bool has_force = force.x != nullptr;
  const bool same = !has_force && !has_force_ && gravity.x == gravity_.x &&
                    gravity.y == gravity_.y && gravity.z == gravity_.z;
  if (same) return;
  gravity_ = gravity;
  has_force_ = has_force;
  const YarnPlaces& places = layout_.places();
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    const double w = model_.inverse_mass[slot];
    if (w == 0) continue;
    const kernels::Vector a = has_force ? gravity + w * force[slot] : gravity;
    const std::size_t at = places.of(slot);
    acceleration_[at] = static_cast<float>(a.x);
    acceleration_[at + places.stride] = static_cast<float>(a.y);
    acceleration_[at + 2 * places.stride] = static_cast<float>(a.z);
  }
}

/// Without a past the particles are taken to have been in free flight.
void SmallStepsSolver::begin_past(Team& team) {
  if (!has_past_) {
    const auto h = static_cast<float>(h_), push = static_cast<float>(h_ * decaying_share());
    for (std::size_t i = 0; i < layout_.floats; ++i) {
      v_before_[i] = v_[i] - push * acceleration_[i];
      u_before_[i] = u_[i] - h * v_[i] + 0.5f * h * h * acceleration_[i];
      predicted_[i] = u_[i];
    }
    return;
  }
  const simd::Past arrays{past_.v.data(), past_.v_before.data(), past_.moved.data()};
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.resume(flight(), arrays, static_cast<float>(past_.h), first, last);
  });
}

/// The base stays for as many substeps as it may, so that what is remembered of it does. It is
/// renewed within a frame only where the frame began with a new one: a frame that is not kept
/// leaves the old one.
void SmallStepsSolver::split(kernels::VectorsView x, int substeps, Team& team) {
  if (std::exchange(is_new_, false)) {
    base_.swap(past_.base);
    is_unmeasured_ = true;
  }
  const YarnPlaces& places = layout_.places();
  const bool stays = has_past_ && past_.since_renewal + substeps <= tuning::kRenewal;
  since_renewal_ = stays ? past_.since_renewal : 0;
  if (!stays) {
    base_.swap(past_.base);
    is_new_ = is_unmeasured_ = true;
  }
  places.clear(u_.data());
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    if (stays)
      places.offset(table_, x, first, last, base_.data(), u_.data());
    else
      places.split(table_, x, layout_.cell, first, last, base_.data(), u_.data());
  });
  if (is_unmeasured_) measure_base(team);
}

void SmallStepsSolver::begin(kernels::VectorsView x, kernels::VectorsView v,
                             kernels::Vector gravity, kernels::VectorsView force,
                             const FramePlan& plan, Team& team) {
  h_ = plan.h;
  omega_ = plan.omega;
  projects_ = plan.projects;
  softest_ = plan.softest;
  is_begun_ = is_aside_ = false;
  passes_.forget();
  seams_.begin(plan.seams, plan.projects ? 0 : plan.h);
  departures_.begin();
  bending_.begin(plan);
  touched_.clear();
  arrived_.clear();
  has_past_ = !plan.placed && plan.h <= SubstepFormula::kLargestRatio * past_.h;
  split(x, plan.substeps, team);
  anchors_.begin(plan.anchors, plan.h, plan.substeps,
                 has_past_ ? past_.at_limit : std::span<const std::uint16_t>{});
  anchors_.measure_base(base_.data());
  begin_bodies(plan);
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().narrow(table_, v, first, last, v_.data());
  });
  write_acceleration(gravity, force);
  begin_past(team);
  if (projects_) advance_bodies(1, team);
  next_formula_ = formula_after(has_past_ ? past_.h : h_);
  weights_.last.rate = 0;
}

void SmallStepsSolver::measure_base(Team& team) {
  is_unmeasured_ = false;
  links_.measure_base(base_.data(), team);
  membrane_.measure_base(base_.data(), team);
  bending_.measure_base(base_.data(), team);
}

void SmallStepsSolver::renew_base(Team& team) {
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.renew_base(flight(), base_.data(), static_cast<float>(layout_.cell), first, last);
  });
  measure_base(team);
  anchors_.measure_base(base_.data());
}

void SmallStepsSolver::advance(Team& team) {
  end_contacts(team);
  take_past_along(team);
  end_motions();
  is_begun_ = false;
  if (since_renewal_++ == tuning::kRenewal) {  // never where the base is the past's
    since_renewal_ = 1;
    renew_base(team);
  }
  if (next_formula_.left < 1) decay(next_formula_.left, team);
  weights_.past = static_cast<float>(next_formula_.past);
  weights_.step = static_cast<float>(next_formula_.part * h_);
  weights_.push = static_cast<float>(next_formula_.part * h_ * next_formula_.share);
  if (settings_.motion_tolerance > 0) {
    settle_floats(team, [&](std::size_t first, std::size_t last) {
      return table_.advance_measured(flight(), weights_, first, last);
    });
  } else {
    for_floats(team, [&](std::size_t first, std::size_t last) {
      table_.advance(flight(), weights_, first, last);
    });
  }
  formula_ = std::exchange(next_formula_, formula_after(h_));
  weights_.last = {weights_.push, static_cast<float>(1 / (formula_.part * h_)),
                   static_cast<float>(formula_.slope)};
  bending_.bend(u_.data(), v_before_.data(), formula_.give(h_), team);
  anchors_.advance();
  advance_bodies(formula_.part, team);
  if (has_attached_) hold_anchors(team);
}

SubstepFormula SmallStepsSolver::formula_after(double h_before) const {
  return SubstepFormula::of(settings_.scheme, h_ / h_before)
      .with_decay(model_.damping.motion, h_, h_before);
}

/// Of h, in which accelerations act in a flight.
double SmallStepsSolver::decaying_share() const {
  return SubstepFormula{}.with_decay(model_.damping.motion, h_, h_).share;
}

/// Of all velocities but those of pins.
void SmallStepsSolver::decay(double to, Team& team) {
  settle_velocities(settings_.motion_tolerance > 0, team);
  const auto left = static_cast<float>(to);
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      v_[i] *= left;
      v_before_[i] *= left;
    }
  });
  const YarnPlaces& places = layout_.places();
  for (const std::uint32_t pin : model_.pins) {
    std::size_t at = places.of(pin);
    for (int axis = 0; axis < 3; ++axis, at += places.stride) {
      v_[at] /= left;
      v_before_[at] /= left;
    }
  }
}

LinkSweep SmallStepsSolver::link_sweep() {
  return {.base = base_.data(),
          .u = u_.data(),
          .u_start = u_before_.data(),
          .laws = law_step(),
          .omega = omega_,
          .continues = is_begun_};
}

void SmallStepsSolver::sweep(Team& team) { sweep(link_sweep(), team); }

void SmallStepsSolver::mend(double to, Team& team) {
  if (model_.has_laws()) set_aside();
  LinkSweep sweep = link_sweep();
  sweep.omega = 1;
  sweep.left = to * settings_.tolerance;
  this->sweep(sweep, team);
}

void SmallStepsSolver::sweep(const LinkSweep& links, Team& team) {
  links_.sweep_yarns(links, team, [&] { hold_anchors(team); });
  links_.sweep_edges(links, team);
  if (model_.constraints.has_springs())
    sweep_serial_springs();
  else
    sweep_serial(links);
  sweep_membrane(team);
  if (layout_.has_single_constraints() || !layout_.has_yarns()) hold_anchors(team);
  draw_seams();
  hold_bodies(team);
  is_begun_ = true;
}

/// What mending does to laws is no motion: a sweep leaves some of their load as an error, and the
/// next one would have it again.
void SmallStepsSolver::set_aside() {
  if (std::exchange(is_aside_, true)) return;
  std::ranges::copy(u_, aside_.begin());
}

/// Where mending has moved a particle its past is moved alike, but for those that a sphere has
/// pushed: they begin a new one, by where they are.
void SmallStepsSolver::take_past_along(Team& team) {
  if (!std::exchange(is_aside_, false)) return;
  const YarnPlaces& places = layout_.places();
  for (const std::uint32_t slot : touched_) {
    std::size_t at = places.of(slot);
    for (int axis = 0; axis < 3; ++axis, at += places.stride) aside_[at] = u_[at];
  }
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const float by = u_[i] - aside_[i];
      predicted_[i] += by;
      u_before_[i] += by;
    }
  });
}

void SmallStepsSolver::judge(Team& team) {
  if (model_.constraints.has_springs()) judge_springs(team);
  judge_membrane(team);
}

/// Finds which springs, and rigid constraints beside them, are out of tolerance.
void SmallStepsSolver::judge_springs(Team& team) {
  links_.judge_springs(link_sweep(), team);
  const LanePoints points = this->points(false);
  const double tolerance = tuning::kLocalShare * settings_.tolerance;
  for (const std::uint32_t c : layout_.serial) {
    if (breaks_law(model_.constraints, points, law_step(), tolerance, c)) passes_.look_near(c);
  }
}

void SmallStepsSolver::sweep_serial(const LinkSweep& sweep) {
  const ConstraintStore& s = model_.constraints;
  LanePoints points = this->points(false);
  const double left = static_cast<double>(SimdLinks::squared(sweep.left));
  for (const std::uint32_t c : layout_.serial) {
    const kernels::Vector d = points.difference(s.a[c], s.b[c]);
    const double rest = s.rest_length[c], square = rest * rest, error = dot(d, d) - square;
    if (std::abs(error) > static_cast<double>(links_.squared_tolerance()) * square)
      passes_.look_near(c);
    if (c >= s.bilateral && error <= 0) continue;
    const kernels::Vector by =
        reference::relaxed_impulse(d, rest, 1 / s.effective_mass[c], sweep.omega, left) * d;
    points.move(s.a[c], -model_.inverse_mass[s.a[c]] * by);
    points.move(s.b[c], model_.inverse_mass[s.b[c]] * by);
  }
}

void SmallStepsSolver::sweep_serial_springs() {
  LanePoints points = this->points(false);
  for (const std::uint32_t c : layout_.serial) {
    sweep_law(model_, points, law_step(), !is_begun_, omega_, c);
  }
}

void SmallStepsSolver::sweep_membrane(Team& team) {
  membrane_.relax(u_.data(), u_before_.data(), law_step(), omega_, is_begun_, team);
}

/// Finds which triangles of fabric are out of tolerance.
void SmallStepsSolver::judge_membrane(Team& team) {
  membrane_.judge(u_.data(), u_before_.data(), law_step(),
                  tuning::kLocalShare * settings_.tolerance, team);
}

std::int64_t SmallStepsSolver::count_out() const {
  return links_.count_out() + membrane_.count_out();
}

/// Constraints that a sweep found out of tolerance have been relaxed since, and so have their
/// neighbours: all of these are looked at again.
void SmallStepsSolver::look_near_what_was_out() {
  links_.for_each_out([&](std::uint32_t c) { passes_.look_near(c); });
  membrane_.for_each_out(
      [&](std::uint32_t element) { passes_.look_near(passes_.item_of_element(element)); });
}

void SmallStepsSolver::draw_seams() {
  if (seams_.empty()) return;
  LanePoints points = this->points(false);
  seams_.draw(points, 1 / law_step().springs.scale, !is_begun_);
}

void SmallStepsSolver::end_seams() {
  if (seams_.empty()) return;
  seams_.end_substep(this->points(false), 1 / law_step().springs.scale, settings_.contact_tolerance,
                     [&](std::uint32_t a, std::uint32_t b) {
                       touched_.push_back(a);
                       touched_.push_back(b);
                     });
}

LocalWork SmallStepsSolver::run_passes(const SphereContacts& contacts, std::int64_t most_visits,
                                       Team& team) {
  if (model_.has_laws()) set_aside();
  LanePoints points = this->points(true);
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

LocalWork SmallStepsSolver::repair(const SphereContacts& contacts, std::int64_t most_visits,
                                   Team& team) {
  look_near_what_was_out();
  return run_passes(contacts, most_visits, team);
}

LocalWork SmallStepsSolver::repair_everywhere(const SphereContacts& contacts,
                                              std::int64_t most_visits, Team& team) {
  passes_.look_everywhere();
  return run_passes(contacts, most_visits, team);
}

double SmallStepsSolver::bending_energy(double give, Team& team) {
  return bending_.energy(u_.data(), give, team);
}

void SmallStepsSolver::settle(Team& team) {
  take_past_along(team);
  end_motions();
  settle_velocities(true, team);
}

void SmallStepsSolver::settle_velocities(bool measures, Team& team) {
  const auto settle = [&](std::size_t first, std::size_t last) {
    return table_.settle(flight(), weights_.last, first, last);
  };
  if (measures)
    settle_floats(team, settle);
  else
    for_floats(team, settle);
  weights_.last.rate = 0;
}

void SmallStepsSolver::read_positions(kernels::VectorsView x, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().join(table_, x, first, last, base_.data(), u_.data());
  });
}

void SmallStepsSolver::read_positions_of(std::span<const std::uint32_t> slots,
                                         kernels::VectorsView x) const {
  const YarnPlaces& places = layout_.places();
  for (const std::uint32_t slot : slots) {
    const std::size_t at = places.of(slot), next = places.stride;
    const auto axis = [&](std::size_t i) {
      return static_cast<double>(base_[i]) + static_cast<double>(u_[i]);
    };
    x.set(slot, {axis(at), axis(at + next), axis(at + 2 * next)});
  }
}

void SmallStepsSolver::read_starts(kernels::VectorsView x, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().join(table_, x, first, last, base_.data(), u_before_.data());
  });
}

double SmallStepsSolver::largest_move(Team& team) {
  for_floats(team, [&](std::size_t first, std::size_t last) {
    largest_[first / kPart] = table_.largest_move(flight(), first, last);
  });
  return std::sqrt(3.) * largest_of_parts();
}

void SmallStepsSolver::read_velocities(kernels::VectorsView v, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().widen(table_, v, first, last, v_.data());
  });
}

void SmallStepsSolver::keep(Team& team) {
  past_.h = h_;
  past_.since_renewal = since_renewal_;
  past_.at_limit = anchors_.at_limit();
  past_.touching = bodies_.touching();
  past_.misplaced = bodies_.meshes().misplaced();
  is_new_ = false;
  const simd::Past arrays{past_.v.data(), past_.v_before.data(), past_.moved.data()};
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.keep_past(flight(), arrays, first, last);
  });
}

std::size_t SmallStepsSolver::bytes() const {
  return 11 * bytes_of(u_) + bytes_of(largest_) + bytes_of(touched_) + bytes_of(arrived_) +
         bytes_of(aside_) + passes_.bytes() + seams_.bytes() + links_.bytes() + membrane_.bytes() +
         bending_.bytes() + anchors_.bytes() + bodies_.bytes() + bytes_of(past_.touching) +
         past_.misplaced.bytes();
}

}  // namespace weft
