#include "engine/step/state.h"

#include <type_traits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/isa.h"
#include "engine/step/choose_solver.h"

namespace weft {

State::State(std::shared_ptr<const Model> shared, const Settings& chosen)
    : model(std::move(shared)), settings(chosen), kernels(&simd::table(to_kernel(chosen.isa))) {
  settings.scheme = scheme_of(settings);
  position = model->initial_position;
  velocity = model->initial_velocity;
  gravity = model->gravity;
  solved.resize(model->slots());
  next_velocity.resize(model->slots());
  start_position.resize(model->slots());
  start_velocity.resize(model->slots());
  kicks.resize((model->slots() + kStretch - 1) / kStretch);
  contacts = make_contact_store(*model);
  if (settings.backend == Backend::reference) {
    predicted.resize(model->slots());
    reference.emplace(*model, settings);
  } else {
    simd.emplace(*model, settings, *kernels);
    measure.emplace(*model, *kernels);
  }
  if (settings.solver == Solver::small_steps) {
    if (reference)
      reference_small_steps.emplace(*model, settings);
    else
      small_steps.emplace(*model, settings, *kernels);
    if (model->has_contacts()) substep_start.resize(model->slots());
  }
  if (settings.solver == Solver::yarn) yarn.emplace(*model, settings, *kernels);
  const bool behind_yarns = yarn && settings.iterations == 0 && model->uneven.ratio > kUneven;
  if (settings.solver == Solver::direct || behind_yarns) direct.emplace(*model, settings, *kernels);
}

namespace {

/// Whether what steps by one came to says how those by the other will go.
bool alike(const Settings& a, const Settings& b) {
  return a.solver == b.solver && a.scheme == b.scheme && a.backend == b.backend &&
         a.iterations == b.iterations && a.tolerance == b.tolerance &&
         a.contact_tolerance == b.contact_tolerance;
}

/// Of small steps, where both states take them.
template <class Solver>
auto copy_of_past(const Solver& to, const Solver& from) {
  using Past = std::remove_cvref_t<decltype(from->past())>;
  return to && from ? from->past() : Past{};
}
template <class Solver, class Past>
void take_past(Solver& solver, Past&& past, bool same) {
  if (!solver) return;
  if (same)
    solver->set_past(std::move(past));
  else
    solver->forget_past();
}

}  // namespace

/// What needs memory first: all of it is copied or, where memory runs out, nothing. Under other
/// settings positions are given ones, and nothing is known of trouble.
void State::copy(const State& from) {
  const bool same = alike(settings, from.settings);
  kernels::Vectors its_force = from.force;
  Pins its_pins = from.pins;
  auto its_past = copy_of_past(small_steps, from.small_steps);
  auto its_reference_past = copy_of_past(reference_small_steps, from.reference_small_steps);
  position = from.position;
  velocity = from.velocity;
  force = std::move(its_force);
  gravity = from.gravity;
  pins = std::move(its_pins);
  trouble = same ? from.trouble : Trouble{};
  take_past(small_steps, std::move(its_past), same);
  take_past(reference_small_steps, std::move(its_reference_past), same);
  placed = !same || from.placed;
  lost_energy = same ? from.lost_energy : 0;
  last_dt = same ? from.last_dt : 0;
}

std::size_t State::bytes() const {
  std::size_t sum = 0;
  for (const kernels::Vectors* v : {&position, &velocity, &force, &solved, &next_velocity,
                                    &start_position, &start_velocity, &substep_start, &predicted}) {
    sum += v->bytes();
  }
  sum += contacts.bytes() + bytes_of(kicks) + pins.bytes() + sizeof(Team::SharedState);
  if (reference) sum += reference->bytes();
  if (simd) sum += simd->bytes() + measure->bytes();
  if (direct) sum += direct->bytes();
  if (yarn) sum += yarn->bytes();
  if (small_steps) sum += small_steps->bytes();
  if (reference_small_steps) sum += reference_small_steps->bytes();
  return sum;
}

}  // namespace weft
