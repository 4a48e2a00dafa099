#include "engine/state.h"

#include <algorithm>

namespace weft {
namespace {

template <class T>
std::size_t bytes_of(const T& vector) {
  return vector.capacity() * sizeof(vector[0]);
}

}  // namespace

State::State(std::shared_ptr<const Model> shared, const Settings& chosen)
    : model(std::move(shared)), settings(chosen) {
  const Model& m = *model;
  const ConstraintStore& s = m.constraints;
  position = m.initial_position;
  velocity = m.initial_velocity;
  for (kernels::Vectors* v : {&predicted, &solved, &next_position, &next_velocity}) {
    v->resize(m.particles);
  }
  if (m.has_contacts()) {
    constraints.a = s.a;
    constraints.b = s.b;
    constraints.target = s.rest_length;
    constraints.effective_mass = s.effective_mass;
    contacts.first.assign(m.particles, reference::kNoContact);
  }
  const bool to_tolerance = settings.iterations == 0;
  constraints.tolerance.resize(s.size());
  for (std::size_t c = 0; c < s.size(); ++c) {
    constraints.tolerance[c] = to_tolerance ? settings.tolerance * s.rest_length[c] : 0;
  }
  reserve_contacts(0);
  if (!settings.anticipate && settings.skip) reference.mask.resize(m.particles);
  if (settings.skip) reference.moved.resize(m.particles);
  if (settings.anticipate) {
    reference.row_product.resize(m.rows.items.size());
    reference.row_ready.resize(s.plain);
    if (settings.skip) reference.changed.resize(m.block_first.size() - 1);
    if (!m.hubs.empty()) reference.hub_motion.resize(m.particles);
  }
}

void State::reserve_contacts(std::size_t count) {
  const std::size_t size = model->constraints.size() + count;
  const bool first_time = constraints.impulse.empty() && constraints.direction.size() == 0;
  if (!first_time && size <= constraints.impulse.size()) return;
  if (model->has_contacts()) {
    constraints.a.resize(size);
    constraints.b.resize(size);
    constraints.target.resize(size);
    constraints.effective_mass.resize(size);
    contacts.next.resize(count);
  }
  const bool to_tolerance = settings.iterations == 0;
  constraints.tolerance.resize(size, to_tolerance ? settings.contact_tolerance : 0);
  constraints.direction.resize(size);
  constraints.impulse.resize(size);
  if (settings.velocity_correction) {
    constraints.velocity_tolerance.resize(size);
    constraints.zero.resize(size);
  }
  size_method_memory(size);
}

void State::size_method_memory(std::size_t size) {
  if (!settings.anticipate) return;
  reference.error.resize(size);
  reference.pending.resize(size);
}

reference::Relaxation State::problem() {
  const Model& m = *model;
  const ConstraintStore& s = m.constraints;
  reference::Relaxation r;
  r.particles = m.particles;
  r.plain = s.plain;
  r.bilateral = s.bilateral;
  r.pulling = s.size();
  r.count = s.size() + contacts.count;
  r.a = m.has_contacts() ? constraints.a.data() : s.a.data();
  r.b = m.has_contacts() ? constraints.b.data() : s.b.data();
  r.effective_mass = m.has_contacts() ? constraints.effective_mass.data() : s.effective_mass.data();
  r.inverse_mass = m.inverse_mass.data();
  r.n = constraints.direction.view();
  r.impulse = constraints.impulse.data();
  return r;
}

reference::Relaxation State::position_problem(double h) {
  reference::Relaxation r = problem();
  r.target =
      model->has_contacts() ? constraints.target.data() : model->constraints.rest_length.data();
  r.tolerance = constraints.tolerance.data();
  r.x = solved.view();
  if (settings.impulse_limit > 0) r.limit = settings.impulse_limit * h;
  return r;
}

reference::Relaxation State::velocity_problem() {
  reference::Relaxation r = problem();
  r.target = constraints.zero.data();
  r.tolerance = constraints.velocity_tolerance.data();
  r.x = next_velocity.view();
  if (settings.impulse_limit > 0) r.limit = settings.impulse_limit;
  return r;
}

reference::Workspace State::workspace() {
  reference::Workspace w;
  w.error = reference.error.data();
  w.pending = reference.pending.data();
  w.row_product = reference.row_product.data();
  w.row_ready = reference.row_ready.data();
  w.hub_motion = reference.hub_motion.view();
  w.hubs = model->hubs;
  w.changed = reference.changed.data();
  w.mask = reference.mask.data();
  w.moved = reference.moved.data();
  return w;
}

reference::ContactLists State::contact_lists() const {
  if (!model->has_contacts()) return {};
  return {contacts.first.data(), contacts.next.data()};
}

std::size_t State::bytes() const {
  std::size_t sum = 0;
  for (const kernels::Vectors* v :
       {&position, &velocity, &force, &predicted, &solved, &next_position, &next_velocity,
        &constraints.direction, &reference.hub_motion}) {
    sum += v->bytes();
  }
  const ConstraintArrays& c = constraints;
  const ReferenceMemory& r = reference;
  return sum + bytes_of(c.a) + bytes_of(c.b) + bytes_of(c.target) + bytes_of(c.effective_mass) +
         bytes_of(c.tolerance) + bytes_of(c.velocity_tolerance) + bytes_of(c.zero) +
         bytes_of(c.impulse) + bytes_of(contacts.first) + bytes_of(contacts.next) +
         bytes_of(r.error) + bytes_of(r.pending) + bytes_of(r.row_product) + bytes_of(r.row_ready) +
         bytes_of(r.changed) + bytes_of(r.moved) + bytes_of(r.mask);
}

}  // namespace weft
