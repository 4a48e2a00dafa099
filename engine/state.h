/// The mutable part of a cloth: the state, the contacts of the present step, the solver's memory.
///
/// Which stage writes what:
///   predict             predicted, solved
///   find_contacts       contacts, the contact range of the constraint arrays
///   solve_positions     solved, direction, impulse (and may add contacts that it ran into)
///   commit              next_position, next_velocity
///   correct_velocities  next_velocity, direction, impulse
///   report              nothing
/// position and velocity change only when the whole step is known to be finite (accept in
/// step.cpp).
#pragma once

#include <weft/weft.h>

#include <memory>
#include <vector>

#include "engine/model.h"
#include "kernels/reference/relax.h"
#include "kernels/vectors.h"

namespace weft {

/// The arrays over constraints [0, model constraints) and contacts behind them. A scene without
/// spheres uses the model's arrays for all that is constant; one with spheres keeps copies that
/// have room for contacts.
struct ConstraintArrays {
  std::vector<std::uint32_t> a, b;                          // with spheres only
  kernels::AlignedVector<double> target, effective_mass;    // with spheres only
  kernels::AlignedVector<double> tolerance;                 // m
  kernels::AlignedVector<double> velocity_tolerance, zero;  // velocity correction only
  kernels::Vectors direction;
  kernels::AlignedVector<double> impulse;
};

/// Pairs near enough to touch in this step, and for each particle the list of its contacts.
struct ContactStore {
  std::size_t count = 0;
  std::vector<std::uint32_t> first;  // per particle
  std::vector<std::uint32_t> next;   // per contact
};

/// What the methods of the reference need; only the arrays of the chosen method are allocated.
struct ReferenceMemory {
  std::vector<double> error, pending, row_product;
  std::vector<reference::Flag> row_ready, changed, moved;
  kernels::Vectors hub_motion;
  std::vector<std::uint64_t> mask;
};

struct State {
  std::shared_ptr<const Model> model;
  Settings settings;

  kernels::Vectors position, velocity;
  kernels::Vectors force;  // empty: none
  kernels::Vectors predicted, solved, next_position, next_velocity;

  ConstraintArrays constraints;
  ContactStore contacts;
  ReferenceMemory reference;

  State(std::shared_ptr<const Model> model, const Settings& settings);
  /// Makes room for so many contacts; grows only.
  void reserve_contacts(std::size_t contacts);
  /// The position problem of this step.
  reference::Relaxation position_problem(double h);
  /// The velocity problem at next_position.
  reference::Relaxation velocity_problem();
  reference::Workspace workspace();
  reference::ContactLists contact_lists() const;
  std::size_t bytes() const;

 private:
  void size_method_memory(std::size_t constraints);
  reference::Relaxation problem();
};

}  // namespace weft
