#include "engine/step/state.h"

#include <algorithm>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/isa.h"
#include "engine/model/change.h"
#include "engine/model/saved_model.h"
#include "engine/solvers/direct/direct_solver.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/sweeps/sweeps.h"
#include "engine/solvers/yarn/yarn_solver.h"
#include "engine/step/choose_solver.h"
#include "engine/step/fast_springs.h"
#include "engine/tuning.h"

namespace weft {

LastingState::LastingState(const Model& model)
    : position(model.initial_position),
      velocity(model.initial_velocity),
      gravity(model.gravity),
      wind(model.air.wind),
      pressures(model.pressures),
      gas(model.pressures.size()),
      anchors(model),
      seams(model),
      sliders(model),
      creases(model),
      rest(model) {}

void LastingState::forget_past() {
  placed = true;
  lost_energy = elastic_energy = give_per_mass = longest_substep = refinement = 0;
  lengthening = {};
}

State::State(std::shared_ptr<const Model> shared, const Settings& chosen)
    : LastingState(*shared),
      model(std::move(shared)),
      settings(chosen),
      kernels(&simd::table(to_kernel(chosen.isa))),
      measure(std::make_unique<Measure>(*model, chosen, *kernels)) {
  settings.scheme = scheme_of(settings);
  for (kernels::Vectors* v :
       {&solved, &next_velocity, &step_start.position, &step_start.velocity}) {
    v->resize(model->slots());
  }
  impulses.resize((model->slots() + kStretch - 1) / kStretch);
  contacts = make_sphere_contacts(*model);
  if (settings.backend == Backend::reference) predicted.resize(model->slots());
  if (model->damping.motion > 0) velocity_before_decay.resize(model->slots());
  if (model->has_air()) {
    air_coefficients.resize(model->air.triangles.size());
  }
  make_room_for_pressure();
  if (model->constraints.has_springs() && settings.solver != Solver::small_steps) {
    laws.emplace(model->constraints);
  }
  make_solvers();
  if (threads_worth_having() > 1) {
    team_state = std::make_unique<Team::SharedState>();
    arena_run = std::make_shared<ArenaRun>();
  }
}

State::~State() = default;
State::State(State&&) noexcept = default;
State& State::operator=(State&&) noexcept = default;

int State::threads_worth_having() const {
  if (settings.backend == Backend::reference) return 1;
  const int most = settings.threads > 0 ? settings.threads : kMaxThreads;
  const std::size_t worth = model->slots() / tuning::kLeastSlotsPerThread;
  return std::max(1, static_cast<int>(std::min(worth, static_cast<std::size_t>(most))));
}

void State::make_room_for_pressure() {
  const bool has_pressure = presses(*this);
  const auto gives_room = [&](kernels::Vectors& v, bool needed) {
    if ((v.size() > 0) != needed) v.resize(needed ? model->slots() : 0);
  };
  gives_room(total_force, has_velocity_forces(*model) || has_pressure);
  gives_room(air_from, model->has_air() || has_pressure);
  gives_room(air_impulse, model->has_air() || has_pressure);
  for (kernels::Vectors* each : {&pressed.beside, &pressed.held, &pressed.before})
    gives_room(*each, has_pressure);
  gives_room(pressed.area, std::ranges::any_of(pressures, &Pressure::gas));
  for (std::vector<double>* each : {&pressed.given, &pressed.volume, &pressed.volume_before})
    each->resize(pressures.size());
  const std::size_t pieces = model->has_ram() ? model->air.is_open.size() : 0;
  pressed.ram.resize(pieces);
  pressed.caught.resize(pieces);
}

void State::make_solvers() {
  const bool to_tolerance = settings.iterations == 0;
  const bool exact = settings.solver == Solver::yarn || settings.solver == Solver::direct;
  const double spheres = model->heaviest_sphere * model->uneven.lightness;
  const bool unequal = std::max(model->uneven.ratio, spheres) > tuning::kUnequalMasses;
  if (settings.solver != Solver::small_steps) {
    sweeps = std::make_unique<Sweeps>(*model, settings, *kernels, *measure);
  }
  Settings own = settings;
  own.threads = threads_worth_having();  // yarns take memory for each
  if (settings.solver == Solver::yarn) {
    yarn = std::make_unique<YarnSolver>(*model, own, *kernels, measure->lanes());
  }
  if (settings.solver == Solver::direct || (yarn && to_tolerance && unequal)) {
    direct = std::make_unique<DirectSolver>(*model, settings, *kernels);
  }
  if (settings.solver == Solver::small_steps || (exact && to_tolerance)) {
    if (exact) own.scheme = Scheme::implicit;  // the stand-in has no past
    small_steps = make_small_steps(*model, own, *kernels);
    if (model->has_spheres()) substep_positions.resize(model->slots());
    if (model->heaviest_sphere > 0) inverse_mass_of_met = model->inverse_mass;
  }
  if (yarn) {
    solver = yarn.get();
    stand_in = direct.get();
  } else if (direct) {
    solver = direct.get();
  } else {
    solver = sweeps.get();
  }
}

/// Parts that need memory come first: all is copied or, where memory runs out, nothing.
void State::copy(const State& from) {
  LastingState its = from;
  const bool same = alike(settings, from.settings);
  if (same && small_steps) small_steps->take_past(*from.small_steps);
  if (!same && small_steps) small_steps->forget_past();
  take(std::move(its), from.settings);
}

void State::take(LastingState&& from, const Settings& its) {
  const bool same = alike(settings, its);
  LastingState::operator=(std::move(from));
  make_room_for_pressure();
  if (!same) forget_past();
  if (!same || !settings.sleep) rest.wake();
}

namespace {

/// Another shape at rest is seen at once; a fingerprint takes longer than a frame of calm cloth.
bool are_different(const Model& a, const Model& b) {
  return a.constraints.rest_length != b.constraints.rest_length ||
         a.membrane.rest != b.membrane.rest || fingerprint(a) != fingerprint(b);
}

}  // namespace

void State::go_on_from(const State& from) {
  const Model& its_model = *from.model;
  LastingState next = from;
  next.position = position;
  next.velocity = velocity;
  if (from.force.size() > 0) next.force = kernels::Vectors(model->slots());
  bool same_masses = true;
  for_each_particle(*model, its_model, [&](std::uint32_t slot, std::uint32_t its_slot) {
    next.position.set(slot, from.position[its_slot]);
    next.velocity.set(slot, from.velocity[its_slot]);
    if (from.force.size() > 0) next.force.set(slot, from.force[its_slot]);
    same_masses = same_masses && model->inverse_mass[slot] == its_model.inverse_mass[its_slot];
    const bool is_free = model->inverse_mass[slot] > 0;
    if (is_free == (its_model.inverse_mass[its_slot] > 0)) return;
    if (its_model.is_attached(its_slot)) return;  // it has the velocity of its point
    next.velocity.set(slot, is_free ? from.pins.last_velocity(its_slot) : kernels::Vector{0, 0, 0});
  });
  next.pins = {};
  next.pins.go_on_from(from.pins, its_model, *model, next.position);
  next.anchors.tie(model->anchors, next.position);
  next.creases = Creases(from.creases, its_model, *model);
  next.rest = rest;
  next.bodies.forget_touching();
  if (are_different(*model, its_model)) next.lengthening = {};
  take(std::move(next), from.settings);
  displaced = true;
  rests_differ = rests_differ || fast_rest_differs(*model, its_model, settings.tolerance);
  if (!same_masses) lost_energy = 0;  // the lost energy was of others
  if (alike(settings, from.settings) && small_steps)
    small_steps->go_on_from(*from.small_steps, velocity.view(), gravity);
}

std::size_t Pressed::bytes() const {
  return bytes_of(given) + bytes_of(volume) + bytes_of(volume_before) + bytes_of(ram) +
         bytes_of(caught) + beside.bytes() + held.bytes() + before.bytes() + area.bytes();
}

std::size_t State::bytes() const {
  std::size_t sum = 0;
  for (const kernels::Vectors* v :
       {&position, &velocity, &force, &total_force, &velocity_before_decay, &solved, &next_velocity,
        &step_start.position, &step_start.velocity, &substep_positions, &predicted, &air_from,
        &air_impulse}) {
    sum += v->bytes();
  }
  sum += contacts.bytes() + nearby.bytes() + coplanar_layers.bytes() + bytes_of(impulses) +
         bytes_of(inverse_mass_of_met) + bytes_of(air_coefficients) + pins.bytes() +
         anchors.bytes() + seams.bytes() + sliders.bytes() + creases.bytes() + bodies.bytes() +
         rest.bytes() + pressed.bytes() + bytes_of(pressures) + bytes_of(gas) + bytes_of(torn) +
         measure->bytes();
  for (const Pressure& part : pressures) sum += bytes_of(part.triangles);
  if (team_state) sum += sizeof(Team::SharedState);
  if (arena_run) sum += sizeof(ArenaRun);
  if (laws) sum += laws->bytes();
  if (sweeps) sum += sweeps->bytes();
  if (yarn) sum += yarn->bytes();
  if (direct) sum += direct->bytes();
  if (small_steps) sum += small_steps->bytes();
  return sum;
}

}  // namespace weft
