/// The mutable part of a cloth: the state, the contacts of the present step, the solver's memory.
///
/// Which stage writes what:
///   predict             solved (and contacts, which the estimate of substeps looks for)
///   find_contacts       contacts
///   solve_positions     solved (and contacts, by those that it ran into)
///   commit              next_velocity, impulses
///   correct_velocities  next_velocity, impulses
///   report              nothing
/// position and velocity change only when a substep is accepted, where pins set out and arrive
/// (pins.h), and where a start is projected (project.h).
#pragma once

#include <weft/weft.h>

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "engine/bodies/bodies.h"
#include "engine/contact/coplanar_layers.h"
#include "engine/measure/measure.h"
#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/parallel/arena.h"
#include "engine/parallel/team.h"
#include "engine/saving/fields.h"
#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/small_steps/body_report.h"
#include "engine/spheres/nearby_pairs.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/anchors.h"
#include "engine/step/creases.h"
#include "engine/step/lengthening.h"
#include "engine/step/pins.h"
#include "engine/step/rest.h"
#include "engine/step/seams.h"
#include "engine/step/sliders.h"
#include "kernels/impulse_energy.h"
#include "kernels/vectors.h"

namespace weft {

class DirectSolver;
class SmallSteps;
class Sweeps;
class YarnSolver;

/// Drag and lift at a corner of a triangle, kg/s (air.h).
struct AirCoefficients {
  double rate = 0;
  kernels::Vector spin{};
};

/// A piece of cloth in the air: sums over its triangles.
struct Caught {
  kernels::Vector mouth{}, moved{};  // m^2, areas times normals; m^3/s, velocities by area
  double area = 0, mass = 0;         // m^2, kg
};

/// The present effect of pressures (pressure.h).
struct Pressed {
  std::vector<double> given;                  // Pa, of each of LastingState::pressures
  std::vector<double> volume, volume_before;  // m^3, of those that are of gas
  std::vector<double> ram;                    // Pa, of each piece in the air
  std::vector<Caught> caught;
  kernels::Vectors beside;        // N, of all but pressures; empty without pressures
  kernels::Vectors held, before;  // N, of all pressures but of gas: now, and in the substep before
  kernels::Vectors area;          // m^2, of a gas
  std::size_t bytes() const;
};

/// A state to return to: what a step may change before it is over.
struct Checkpoint {
  kernels::Vectors position, velocity;
  Seams seams;
  Sliders sliders;
  Creases creases;
  std::vector<FreeBody> bodies;  // those that move by themselves
  double lost_energy = 0, elastic_energy = 0, give_per_mass = 0, longest_substep = 0;
};

/// The way that carry has taken a cloth since the last step, as a motion of all space: at x it is
/// moved + turned x x. It is slow, since it is of a frame: squares of angles are left out.
struct CarriedWay {
  kernels::Vector moved{};   // m
  kernels::Vector turned{};  // rad

  void add(const RigidMotion& motion, double share);
  kernels::Vector at(kernels::Vector x) const { return moved + cross(turned, x); }
  friend void visit_fields(Is<CarriedWay> auto& way, auto& archive) {
    auto& [moved, turned] = way;
    archive(moved, turned);
  }
};

/// Data that go on into the next step, and so are copied and saved, but for the memory of solvers.
/// All else of a State is made in each step, or follows from the model and the settings.
struct LastingState {
  kernels::Vectors position, velocity;
  kernels::Vectors force;  // external; empty: none
  kernels::Vector gravity{}, wind{};
  CarriedWay way;  // through the air
  std::vector<Pressure> pressures;
  std::vector<double> gas;  // Pa, of each pressure: what the last substep came to; 0: of no gas
  Pins pins;
  Anchors anchors;
  Seams seams;
  Sliders sliders;
  Creases creases;
  Bodies bodies;
  bool placed = true;         // positions were given, not stepped to: they may violate constraints
  bool displaced = false;     // they may, though stepped to: a pin was put down, the model changed
  bool rests_differ = false;  // the rest of fast springs has changed since (fast_springs.h)
  double lost_energy = 0;     // J, lately (energy.h)
  double elastic_energy = 0;  // J, of springs, where the present substep begins; not of small steps
  double give_per_mass = 0;   // s^2, of springs in the last step (measure/state_measure.h)
  double longest_substep = 0;  // s, of a solver, since positions were given
  double refinement = 0;       // log2 of the next step's parts, or how much shorter its substeps
  Lengthening lengthening;     // with refinement, of small steps without a motion_tolerance
  Rest rest;
  StepReport asleep;  // the report of its steps while the cloth sleeps

  explicit LastingState(const Model& model);
  /// Something was changed from outside.
  void wake() {
    lengthening = {};
    rest.wake();
  }
  /// All of it under other settings: positions are given ones, and nothing is known of the past.
  void forget_past();
  friend void visit_fields(Is<LastingState> auto& state, auto& archive) {
    auto& [position, velocity, force, gravity, wind, way, pressures, gas, pins, anchors, seams,
           sliders, creases, bodies, placed, displaced, rests_differ, lost_energy, elastic_energy,
           give_per_mass, longest_substep, refinement, lengthening, rest, asleep] = state;
    archive(position, velocity, force, gravity, wind, way, pressures, gas, pins, anchors, seams,
            sliders, creases, bodies, placed, displaced, rests_differ, lost_energy, elastic_energy,
            give_per_mass, longest_substep, refinement, lengthening, rest, asleep);
  }
};

struct State : LastingState {
  std::shared_ptr<const Model> model;
  Settings settings;  // isa, solver, substeps and velocity_correction resolved

  kernels::Vectors velocity_before_decay;  // for an attempt that is rejected; with decay only
  kernels::Vectors total_force;  // besides gravity (air.h); empty where velocities cause none
  std::vector<AirCoefficients> air_coefficients;  // per triangle
  kernels::Vectors air_from, air_impulse;         // of small steps: in a part of a frame, m and N s
  Pressed pressed;
  double air_parts = 1;       // of a frame of small steps, in which the air is looked at (air.h)
  double air_turning = 0;     // 1/s, when the frame begins (AirPace)
  double way_per_second = 0;  // 1 over the length of the present step
  /// m/s, of the air about x, as the cloth sees it.
  kernels::Vector wind_at(kernels::Vector x) const { return wind - way_per_second * way.at(x); }
  kernels::Vectors solved;  // where the position loop works; the next positions
  kernels::Vectors next_velocity;
  Checkpoint step_start;
  kernels::Vectors substep_positions;  // where a fast substep began; with contacts only
  SphereContacts contacts;
  NearbySpherePairs nearby;  // of the present frame of small steps
  CoplanarLayers coplanar_layers;
  std::optional<Gaps> gaps;  // of the cloth, once a body asks for them
  BodyReport body_report;    // of the present attempt by small steps
  std::vector<Torn> torn;    // when the last step ended

  std::vector<kernels::ImpulseEnergy> impulses;  // per stretch of slots
  kernels::AlignedVector<double>
      inverse_mass_of_met;  // scratch of motion.h; with free spheres only

  const simd::Table* kernels;
  std::unique_ptr<Measure> measure;
  kernels::Vectors predicted;      // reference backend only
  std::optional<SpringLaws> laws;  // of the last substep; with springs, unless by small steps
  // Those that the settings need. Small steps do the work that a solver gives up.
  std::unique_ptr<Sweeps> sweeps;
  std::unique_ptr<YarnSolver> yarn;
  std::unique_ptr<DirectSolver> direct;
  std::unique_ptr<SmallSteps> small_steps;
  ConstraintSolver* solver = nullptr;    // the chosen one of sweeps, yarn and direct
  ConstraintSolver* stand_in = nullptr;  // direct, behind yarns of unequal masses
  // Of a cloth that is worth several threads, or has led a batch; else null.
  std::unique_ptr<Team::SharedState> team_state;
  std::shared_ptr<ArenaRun> arena_run;
  bool is_in_batch = false;  // and has not been stepped in it

  State(std::shared_ptr<const Model> model, const Settings& settings);
  ~State();
  State(State&&) noexcept;
  State& operator=(State&&) noexcept;
  /// Forces besides gravity; empty: none.
  kernels::Vectors& forces() { return total_force.size() > 0 ? total_force : force; }
  const kernels::Vectors& forces() const { return total_force.size() > 0 ? total_force : force; }
  /// Goes on from another state of the same model.
  void copy(const State& from);
  /// Goes on where another state was, whose settings were `its`; the memory of solvers is taken or
  /// forgotten by the caller.
  void take(LastingState&& from, const Settings& its);
  /// Goes on from one of another model of the same particles. Particles that the models do not
  /// agree on are at rest if fixed, and have the speed of their last move if free.
  void go_on_from(const State& from);
  /// Gives `pressed` the size that pressures need, and total_force.
  void make_room_for_pressure();
  std::size_t bytes() const;
  /// How many threads a step of it is worth, where Settings::threads allows them.
  int threads_worth_having() const;

 private:
  void make_solvers();
};

/// Whether velocities cause forces (air.h).
inline bool has_velocity_forces(const Model& model) {
  return model.has_air() || model.damping.motion > 0;
}
/// Whether triangles feel a pressure (pressure.h).
inline bool presses(const State& s) { return !s.pressures.empty() || s.model->has_ram(); }

/// Settings for which the memory of solvers, and the known past, are worth something.
template <class Any>
auto memory_settings(Any& s) {
  return std::tie(s.solver, s.scheme, s.backend, s.iterations, s.tolerance, s.contact_tolerance,
                  s.motion_tolerance);
}
/// Whether what steps by one came to says how those by the other will go.
inline bool alike(const Settings& a, const Settings& b) {
  return memory_settings(a) == memory_settings(b);
}

}  // namespace weft
