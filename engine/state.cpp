#include "engine/state.h"

#include "engine/isa.h"

namespace weft {

State::State(std::shared_ptr<const Model> shared, const Settings& chosen)
    : model(std::move(shared)), settings(chosen), kernels(&simd::table(to_kernel(chosen.isa))) {
  position = model->initial_position;
  velocity = model->initial_velocity;
  solved.resize(model->slots());
  next_velocity.resize(model->slots());
  start_position.resize(model->slots());
  start_velocity.resize(model->slots());
  if (settings.scheme == Scheme::rattle) kicks.resize((model->slots() + kStretch - 1) / kStretch);
  contacts = make_contact_store(*model);
  if (settings.backend == Backend::reference) {
    predicted.resize(model->slots());
    reference.emplace(*model, settings);
  } else {
    simd.emplace(*model, settings, to_kernel(settings.isa));
  }
  if (settings.solver == Solver::direct) direct.emplace(*model, settings, *kernels);
  if (settings.solver == Solver::yarn) yarn.emplace(*model, settings, *kernels);
}

std::size_t State::bytes() const {
  std::size_t sum = 0;
  for (const kernels::Vectors* v : {&position, &velocity, &force, &solved, &next_velocity,
                                    &start_position, &start_velocity, &predicted}) {
    sum += v->bytes();
  }
  const auto list = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  sum += list(contacts.sphere) + list(contacts.particle) + list(contacts.distance) +
         list(contacts.first) + list(contacts.next) + list(contacts.found);
  sum += kicks.capacity() * sizeof(kernels::Kicks);
  sum += pins.bytes();
  if (reference) sum += reference->bytes();
  if (simd) sum += simd->bytes();
  if (direct) sum += direct->bytes();
  if (yarn) sum += yarn->bytes();
  return sum;
}

}  // namespace weft
