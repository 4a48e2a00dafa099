/// The particles of small steps, as a frame uses them (small_steps.cpp): a concept that both stores
/// satisfy, LaneStore in lanes and ReferenceStore in double, so that neither lacks an operation.
///
/// A frame calls the operations in the order in which they stand here. x and v are read and written
/// in double, in slots.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/frame_to_do.h"
#include "engine/solvers/small_steps/substep.h"
#include "engine/turn.h"
#include "kernels/vectors.h"

namespace weft {

// The beginning of a frame, in this order. begin_bending() begins the bending of a frame with the
// accelerations that accelerate() gave.
template <class Store>
concept BeginsFrames = requires(Store store, kernels::VectorsView x, kernels::VectorsView v,
                                kernels::Vector gravity, const FramePlan& plan, Team& team) {
  store.begin(x, v, plan, team);
  store.accelerate(gravity, x);
  store.begin_bending(plan);
  store.begin_past(team);
  store.begin_bodies(plan);
};

// The prediction of a substep, by Substep::next_formula. settle() ends the last one, and predict()
// begins the next: both return the largest component of the departures of the last one (m/s^2), if
// that was asked for and it had not ended before.
template <class Store>
concept Predicts = requires(Store store, bool measures, double left, double part, Team& team) {
  store.renew_base(team);
  { store.settle(measures, team) } -> std::same_as<std::optional<double>>;
  store.decay(left, team);
  { store.predict(team) } -> std::same_as<std::optional<double>>;
  store.advance_anchors();
  store.advance_bodies(part, team);
  store.bend(team);
};

// A sweep, and limits. sweep_yarns() calls its function after each family of yarns. The judges find
// which springs, rigid constraints beside them and triangles of fabric are out of tolerance;
// for_each_out() calls its function for each of these items (local_passes.h).
template <class Store>
concept SweepsOnce = requires(Store store, const Store& seen, const Relaxation& by, Team& team) {
  store.sweep_yarns(by, team, [] {});
  store.sweep_edges(by, team);
  store.sweep_membrane(team);
  store.hold_anchors(team);
  store.hold_bodies(team);
  store.hold_by_meshes(team);
  store.judge_springs(team);
  store.judge_membrane(team);
  { seen.count_out() } -> std::same_as<std::int64_t>;
  seen.for_each_out([](std::uint32_t) {});
  { store.deepest_in_body(team) } -> std::same_as<double>;
};

// Where a motion ends.
//
// stop_at_contact(): the velocity v of a particle that was pushed is the mean one of this substep,
// and its past is such that the next one begins as by the implicit Euler method: with v + h a, at
// x + h v + h^2 a. begin_at_limit(): the velocity is that at the end of this substep, and the past
// a free flight that leads to it. jump_velocity(): the velocity before jumps by as much as the
// present one did, and the last way is that of a flight between the two.
//
// set_aside() remembers positions before mending, and take_past_along() moves the past of those
// that mending has moved.
template <class Store>
concept EndsMotions = requires(Store store, std::uint32_t slot, kernels::Vector by, Team& team) {
  store.stop_at_contact(slot);
  store.begin_at_limit(slot);
  store.jump_velocity(slot, by);
  store.set_aside();
  store.take_past_along(team);
};

template <class Store>
concept IsRead = requires(Store store, const Store& seen, kernels::VectorsView x,
                          std::span<const std::uint32_t> slots, double h, Team& team) {
  seen.read_positions(x, team);
  seen.read_positions_of(slots, x);
  seen.read_starts(x, team);
  seen.read_velocities(x, team);
  { store.velocity(slots[0]) } -> std::same_as<kernels::Vector>;
  { store.velocity_before(slots[0]) } -> std::same_as<kernels::Vector>;
  { store.largest_move(team) } -> std::same_as<double>;
  { store.bending_energy(h, team) } -> std::same_as<double>;
  { store.releasable_bending_energy(x, h, team) } -> std::same_as<double>;
  { seen.bending_error() } -> std::same_as<double>;
  { seen.rounding_error(h) } -> std::same_as<double>;
  { seen.bytes() } -> std::same_as<std::size_t>;
};

// The past of a flight between two frames. keep() makes it of the frame that ends, dt_of_past() is
// the length of its last substep, or 0 where there is none.
template <class Store>
concept KeepsPast = requires(Store store, const Store& other, kernels::VectorsView v,
                             kernels::Vector gravity, const Turn& by, ArchiveWriter& to,
                             ArchiveReader& from, Team& team) {
  { other.dt_of_past() } -> std::same_as<double>;
  store.keep(team);
  store.take_past(other);
  store.go_on_from(other, v, gravity);
  store.forget_past();
  other.save_past(to);
  { store.load_past(from) } -> std::same_as<bool>;
  store.turn(by);
};

// Bending that yields (creases.h). resolved_bending(): 1/s^2, as reference::energy has it.
// set_fold(): the rest of an element, in m, from now on.
template <class Store>
concept Yields = requires(Store store, const Store& seen, std::uint32_t element, double value) {
  { seen.has_bent() } -> std::same_as<bool>;
  { seen.resolved_bending(value) } -> std::same_as<double>;
  store.set_fold(element, value);
};

/// Points: the particles as local passes, anchors and bodies see and move them.
/// points(with_limits): anchors and bodies hold those that are moved. bodies(): contact with
/// bodies.
template <class Store>
concept ParticleStore = std::constructible_from<Store, Substep&, const simd::Table&> &&
    BeginsFrames<Store> && Predicts<Store> && SweepsOnce<Store> && EndsMotions<Store> &&
    IsRead<Store> && KeepsPast<Store> && Yields<Store> && requires(Store store, bool with_limits) {
  { store.points(with_limits) } -> std::same_as<typename Store::Points>;
  store.bodies();
};

}  // namespace weft
