#include "engine/solvers/small_steps/lane_store.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr std::size_t kPart = 4 * kStretch;  // floats that a thread takes at a time

}  // namespace

LaneStore::LaneStore(Substep& now, const simd::Table& table)
    : now_(now),
      model_(now.model),
      layout_(model_.small_steps()),
      table_(table),
      links_(model_, now.settings, table),
      membrane_(model_, table),
      bending_(model_, now.settings, table),
      anchors_(model_, now.settings, table),
      bodies_(model_, now.settings, table),
      largest_((layout_.floats + kPart - 1) / kPart) {
  for (auto* array : {&base_, &u_, &u_before_, &predicted_, &v_, &v_before_, &acceleration_}) {
    array->resize(layout_.floats);
  }
  for (auto* array : {&past_.v, &past_.v_before, &past_.moved, &past_.base})
    array->resize(layout_.floats);
  if (model_.has_laws()) aside_.resize(layout_.floats);
  past_.at_limit = anchors_.at_limit();
}

LanePoints LaneStore::points(bool with_limits) {
  return {.places = layout_.places(),
          .base = base_.data(),
          .u = u_.data(),
          .predicted = predicted_.data(),
          .u_start = u_before_.data(),
          .touched = now_.touched,
          .multiplier_place = layout_.multiplier_place,
          .multipliers = links_.multipliers(),
          .v = v_.data(),
          .rate = static_cast<double>(weights_.last.rate),
          .anchor_at = with_limits && !anchors_.empty() ? model_.anchors.at.data() : nullptr,
          .anchors = anchors_.clock(),
          .membrane = membrane_,
          .bodies = with_limits && !bodies_.empty() ? &bodies_ : nullptr,
          .arrived = now_.arrived,
          .velocity_jumps = now_.velocity_jumps,
          .led_to = now_.is_aside ? aside_.data() : u_.data()};
}

simd::Flight LaneStore::flight() {
  return {u_.data(),
          u_before_.data(),
          predicted_.data(),
          v_.data(),
          v_before_.data(),
          acceleration_.data(),
          now_.is_aside ? aside_.data() : u_.data()};
}

template <class Work>
void LaneStore::for_floats(Team& team, Work&& work) {
  team.for_each_part(layout_.floats, kPart, work);
}

/// The largest departure of the floats of work that ends a substep, if it had not ended before.
template <class Work>
std::optional<double> LaneStore::settle_floats(Team& team, Work&& work) {
  for_floats(team, [&](std::size_t first, std::size_t last) {
    largest_[first / kPart] = work(first, last);
  });
  return weights_.last.rate != 0 ? std::optional(largest_of_parts()) : std::nullopt;
}

double LaneStore::largest_of_parts() const {
  return largest_.empty() ? 0 : static_cast<double>(*std::ranges::max_element(largest_));
}

/// Lengths of constraints are rounded to 2^-24, and their corrections are velocities over h. In
/// the mean of the largest of some thousands three times that was measured.
double LaneStore::rounding_error(double h) const {
  return 3 * 0x1p-24 * layout_.load.mean_length / h;
}

/// Only where it may have changed.
void LaneStore::accelerate(kernels::Vector gravity, kernels::VectorsView force) {
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

void LaneStore::begin_bending(const FramePlan& plan) {
  bending_.begin(plan, acceleration_.data(), now_.has_past && past_.dt_substep == now_.dt_substep);
}

double LaneStore::releasable_bending_energy(kernels::VectorsView x, double give, Team& team) {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().offset(table_, x, first, last, base_.data(), predicted_.data());
  });
  return bending_.releasable_energy(predicted_.data(), give, team);
}

/// Without a past the particles are taken to have been in free flight.
void LaneStore::begin_past(Team& team) {
  if (!now_.has_past) {
    const auto h = static_cast<float>(now_.dt_substep),
               push = static_cast<float>(now_.dt_substep * now_.decaying_share());
    for (std::size_t i = 0; i < layout_.floats; ++i) {
      v_before_[i] = v_[i] - push * acceleration_[i];
      u_before_[i] = u_[i] - h * v_[i] + 0.5f * h * h * acceleration_[i];
      predicted_[i] = u_[i];
    }
    return;
  }
  const simd::Past arrays{past_.v.data(), past_.v_before.data(), past_.moved.data()};
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.resume(flight(), arrays, static_cast<float>(past_.dt_substep), first, last);
  });
}

/// The base stays for as many substeps as it may, so that what is remembered of it does. It is
/// renewed within a frame only where the frame began with a new one: a frame that is not kept
/// leaves the old one.
void LaneStore::split(kernels::VectorsView x, int substeps, Team& team) {
  if (std::exchange(is_new_, false)) {
    base_.swap(past_.base);
    is_unmeasured_ = true;
  }
  const YarnPlaces& places = layout_.places();
  const bool stays = now_.has_past && past_.since_renewal + substeps <= tuning::kRenewal;
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

void LaneStore::begin(kernels::VectorsView x, kernels::VectorsView v, const FramePlan& plan,
                      Team& team) {
  split(x, plan.substeps, team);
  anchors_.begin(plan.anchors, plan.dt_substep, plan.substeps,
                 now_.has_past ? past_.at_limit : std::span<const std::uint16_t>{});
  anchors_.measure_base(base_.data());
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().narrow(table_, v, first, last, v_.data());
  });
  weights_.last.rate = 0;
}

void LaneStore::measure_base(Team& team) {
  is_unmeasured_ = false;
  links_.measure_base(base_.data(), team);
  membrane_.measure_base(base_.data(), team);
  bending_.measure_base(base_.data(), team);
}

void LaneStore::renew_base(Team& team) {
  if (since_renewal_++ != tuning::kRenewal) return;  // always where the base is the past's
  since_renewal_ = 1;
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.renew_base(flight(), base_.data(), static_cast<float>(layout_.cell), first, last);
  });
  measure_base(team);
  anchors_.measure_base(base_.data());
}

std::optional<double> LaneStore::predict(Team& team) {
  const SubstepFormula& formula = now_.next_formula;
  const double bh = formula.part * now_.dt_substep;
  weights_.past = static_cast<float>(formula.past);
  weights_.step = static_cast<float>(bh);
  weights_.push = static_cast<float>(bh * formula.share);
  std::optional<double> largest;
  if (now_.measures_departures()) {
    largest = settle_floats(team, [&](std::size_t first, std::size_t last) {
      return table_.advance_measured(flight(), weights_, first, last);
    });
  } else {
    for_floats(team, [&](std::size_t first, std::size_t last) {
      table_.advance(flight(), weights_, first, last);
    });
  }
  weights_.last = {weights_.push, static_cast<float>(1 / bh), static_cast<float>(formula.slope)};
  return largest;
}

/// The decay of all velocities but those of pins.
void LaneStore::decay(double to, Team& team) {
  constexpr float kLeast = 1e-30f;  // by which floats can be divided again
  const float left = std::max(static_cast<float>(to), kLeast);
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

LinkSweep LaneStore::link_sweep(const Relaxation& by) {
  return {.base = base_.data(),
          .u = u_.data(),
          .u_start = u_before_.data(),
          .laws = now_.law_step(),
          .omega = by.omega,
          .left = by.left,
          .continues = now_.is_begun};
}

void LaneStore::sweep_edges(const Relaxation& by, Team& team) {
  const LinkSweep links = link_sweep(by);
  links_.sweep_edges(links, team);
  if (model_.constraints.has_springs())
    sweep_serial_springs();
  else
    sweep_serial(links);
}

void LaneStore::take_past_along(Team& team) {
  const YarnPlaces& places = layout_.places();
  for (const std::uint32_t slot : now_.touched) {
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

/// Finds which springs, and rigid constraints beside them, are out of tolerance.
void LaneStore::judge_springs(Team& team) {
  links_.judge_springs(link_sweep({now_.omega, 0}), team);
  const LanePoints points = this->points(false);
  const double tolerance = now_.local_tolerance();
  for (const std::uint32_t c : layout_.serial) {
    if (violation_of_law(model_.constraints, points, now_.law_step(), c) > tolerance)
      now_.passes.look_near(c);
  }
}

void LaneStore::sweep_serial(const LinkSweep& sweep) {
  const ConstraintStore& s = model_.constraints;
  LanePoints points = this->points(false);
  const double left = static_cast<double>(SimdLinks::squared(sweep.left));
  for (const std::uint32_t c : layout_.serial) {
    const kernels::Vector d = points.difference(s.a[c], s.b[c]);
    const double rest = s.rest_length[c], square = rest * rest, error = dot(d, d) - square;
    if (std::abs(error) > static_cast<double>(links_.squared_tolerance()) * square)
      now_.passes.look_near(c);
    if (c >= s.bilateral && error <= 0) continue;
    const kernels::Vector by =
        reference::relaxed_impulse(d, rest, 1 / s.effective_mass[c], sweep.omega, left) * d;
    points.move(s.a[c], -model_.inverse_mass[s.a[c]] * by);
    points.move(s.b[c], model_.inverse_mass[s.b[c]] * by);
  }
}

void LaneStore::sweep_serial_springs() {
  LanePoints points = this->points(false);
  for (const std::uint32_t c : layout_.serial) {
    sweep_law(model_, points, now_.law_step(), !now_.is_begun, now_.omega, c);
  }
}

void LaneStore::sweep_membrane(Team& team) {
  membrane_.relax(u_.data(), u_before_.data(), now_.law_step(), now_.omega, now_.is_begun, team);
}

/// Finds which triangles of fabric are out of tolerance.
void LaneStore::judge_membrane(Team& team) {
  membrane_.judge(u_.data(), u_before_.data(), now_.law_step(), now_.local_tolerance(), team);
}

std::optional<double> LaneStore::settle(bool measures, Team& team) {
  const auto settle = [&](std::size_t first, std::size_t last) {
    return table_.settle(flight(), weights_.last, first, last);
  };
  std::optional<double> largest;
  if (measures)
    largest = settle_floats(team, settle);
  else
    for_floats(team, settle);
  weights_.last.rate = 0;
  return largest;
}

void LaneStore::read_positions(kernels::VectorsView x, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().join(table_, x, first, last, base_.data(), u_.data());
  });
}

void LaneStore::read_positions_of(std::span<const std::uint32_t> slots,
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

void LaneStore::read_starts(kernels::VectorsView x, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().join(table_, x, first, last, base_.data(), u_before_.data());
  });
}

double LaneStore::largest_move(Team& team) {
  for_floats(team, [&](std::size_t first, std::size_t last) {
    largest_[first / kPart] = table_.largest_move(flight(), first, last);
  });
  return std::sqrt(3.) * largest_of_parts();
}

void LaneStore::read_velocities(kernels::VectorsView v, Team& team) const {
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places().widen(table_, v, first, last, v_.data());
  });
}

void LaneStore::keep(Team& team) {
  past_.dt_substep = now_.dt_substep;
  past_.since_renewal = since_renewal_;
  past_.at_limit = anchors_.at_limit();
  past_.touching = bodies_.touching();
  past_.misplaced = bodies_.meshes().misplaced();
  bodies_.remember(past_.contacts);
  is_new_ = false;
  const simd::Past arrays{past_.v.data(), past_.v_before.data(), past_.moved.data()};
  for_floats(team, [&](std::size_t first, std::size_t last) {
    table_.keep_past(flight(), arrays, first, last);
  });
}

std::size_t LaneStore::bytes() const {
  return 11 * bytes_of(u_) + bytes_of(largest_) + bytes_of(aside_) + at_hand_.bytes() +
         links_.bytes() + membrane_.bytes() + bending_.bytes() + anchors_.bytes() +
         bodies_.bytes() + bytes_of(past_.touching) + past_.misplaced.bytes() +
         past_.contacts.bytes();
}

}  // namespace weft
