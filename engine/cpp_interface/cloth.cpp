#include <weft/weft.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/bodies/validate_bodies.h"
#include "engine/isa.h"
#include "engine/measure/state_measure.h"
#include "engine/model/change.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/carry.h"
#include "engine/step/choose_solver.h"
#include "engine/step/saved_state.h"
#include "engine/step/state.h"
#include "engine/step/step.h"
#include "engine/step/step_in_team.h"
#include "engine/step/validate_settings.h"
#include "engine/validation.h"

namespace weft {
namespace {

Result<void> read(const Model& model, const kernels::Vectors& from, std::span<Vec3> out) {
  if (auto r = validate_size("out", out.size(), model.particles); !r) return r;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = to_public(from[model.ordering.slot_of[i]]);
  }
  return {};
}

Result<void> read(const Model& model, const kernels::Vectors& from, FloatVectors out,
                  kernels::Vector origin) {
  if (auto r = validate_floats("out", out, model.particles); !r) return r;
  const std::vector<std::uint32_t>& slot_of = model.ordering.slot_of;
  for (std::size_t i = 0; i < slot_of.size(); ++i) {
    float* const to = &out.floats[i * out.stride];
    const kernels::Vector v = from[slot_of[i]] - origin;
    to[0] = static_cast<float>(v.x);
    to[1] = static_cast<float>(v.y);
    to[2] = static_cast<float>(v.z);
  }
  return {};
}

void hash_bits(std::uint64_t& hash, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int byte = 0; byte < 8; ++byte) {
    hash ^= (bits >> (8 * byte)) & 0xff;
    hash *= 0x100000001b3u;
  }
}

void hash_bits(std::uint64_t& hash, const Model& model, const kernels::Vectors& vectors) {
  for (const std::uint32_t slot : model.ordering.slot_of) {
    hash_bits(hash, vectors.x[slot]);
    hash_bits(hash, vectors.y[slot]);
    hash_bits(hash, vectors.z[slot]);
  }
}

/// Gives `to` the value, and wakes the cloth if that is another one.
void set(kernels::Vector& to, Vec3 value, Rest& rest) {
  const kernels::Vector from = std::exchange(to, to_internal(value));
  if (from.x != to.x || from.y != to.y || from.z != to.z) rest.wake();
}
void set(kernels::Vectors& vectors, std::size_t i, Vec3 value, Rest& rest) {
  kernels::Vector vector = vectors[i];
  set(vector, value, rest);
  vectors.set(i, vector);
}

bool is_identity(const RigidMotion& motion) {
  const auto is_none = [](Vec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; };
  return is_none(motion.translation) && is_none(motion.rotation);
}

bool is_empty(const Changes& changes) {
  return changes.fix.empty() && changes.release.empty() && changes.masses.empty() &&
         changes.rest_lengths.empty() && changes.compliances.empty() && changes.membrane.empty() &&
         changes.bending.empty() && !changes.damping && !changes.air;
}

/// What is used for a model: asked is valid in itself, and its isa is chosen.
Result<Settings> resolve(const Settings& asked, const Model& model) {
  if (asked.backend == Backend::simd) {
    if (auto valid = validate_for_lanes(asked, model); !valid) return Error{valid.error()};
  }
  Settings resolved = asked;
  resolved.velocity_correction |= asked.scheme == Scheme::rattle;
  choose_solver(model, resolved);
  if (auto valid = validate_for_solver(resolved, model); !valid) return Error{valid.error()};
  return resolved;
}

}  // namespace

struct Cloth::Impl : State {
  const Settings asked;

  Impl(std::shared_ptr<const Model> shared, const Settings& wanted, const Settings& resolved)
      : State(std::move(shared), resolved), asked(wanted) {}
  /// A new state of the model by what is asked for of this one.
  Result<std::unique_ptr<Impl>> of(const std::shared_ptr<const Model>& other) const {
    auto resolved = resolve(asked, *other);
    if (!resolved) return Error{resolved.error()};
    return std::make_unique<Impl>(other, asked, resolved.value());
  }
  /// That goes on from this one.
  Result<std::unique_ptr<Impl>> going_on(const std::shared_ptr<const Model>& other) const {
    auto next = of(other);
    if (next) next.value()->go_on_from(*this);
    return next;
  }
  /// A new state that may have bodies: by small steps, which an automatic solver becomes.
  Result<std::unique_ptr<Impl>> for_bodies() const {
    if (settings.solver == Solver::small_steps) return of(model);
    if (asked.solver != Solver::automatic)
      return refuse("body", "needs solver small_steps", std::string(name(settings.solver)));
    Settings wanted = asked;
    wanted.solver = Solver::small_steps;
    auto resolved = resolve(wanted, *model);
    if (!resolved) return Error{resolved.error()};
    return std::make_unique<Impl>(model, wanted, resolved.value());
  }
  Result<void> validate_body(std::uint32_t id) const {
    if (bodies.has(id)) return {};
    return refuse("body", "no such body", std::to_string(id));
  }
  Result<void> validate_vertices(std::uint32_t id, std::span<const Vec3> vertices) const;
  std::uint32_t slot(std::uint32_t particle) const { return model->ordering.slot_of[particle]; }
  Result<void> take_along(const RigidMotion& motion, double share);
  bool is_pin(std::uint32_t particle) const {
    return particle < model->particles && model->inverse_mass[slot(particle)] == 0 &&
           !model->is_attached(slot(particle));
  }
  Result<void> validate_pin(const std::string& field, std::uint32_t particle) const {
    if (is_pin(particle)) return {};
    if (auto r = validate_particle(field, particle, model->particles); !r) return r;
    return refuse(field, "is not fixed", std::to_string(particle));
  }
  Result<void> validate_pins(std::span<const std::uint32_t> particles,
                             std::span<const Vec3> to) const {
    if (auto r = validate_vectors("positions", to, particles.size()); !r) return r;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (!is_pin(particles[i])) return validate_pin(element("particles", i), particles[i]);
    }
    return {};
  }
};

Cloth::Cloth(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Cloth::Cloth(Cloth&&) noexcept = default;
Cloth& Cloth::operator=(Cloth&&) noexcept = default;
Cloth::~Cloth() = default;

Result<Cloth> Cloth::create(std::shared_ptr<const Model> model, const Settings& settings) {
  if (!model) return Error{"model: must not be null (null)"};
  if (auto valid = validate(settings); !valid) return Error{valid.error()};
  auto isa = resolve(settings.isa);
  if (!isa) return Error{isa.error()};
  Settings asked = settings;
  asked.isa = isa.value();
  auto resolved = resolve(asked, *model);
  if (!resolved) return Error{resolved.error()};
  return Cloth(std::make_unique<Impl>(std::move(model), asked, resolved.value()));
}

Cloth Cloth::clone() const {
  Cloth copy(std::make_unique<Impl>(impl_->model, impl_->asked, impl_->settings));
  copy.impl_->copy(*impl_);
  return copy;
}

Result<void> Cloth::copy_state(const Cloth& from) {
  if (!are_related(*from.impl_->model, *impl_->model)) {
    return Error{"from: is a cloth of another model (" + std::to_string(from.particle_count()) +
                 " particles)"};
  }
  if (from.impl_->bodies.any()) {
    if (auto prepared = prepare_for_bodies(); !prepared) return prepared;
  }
  if (from.impl_->model == impl_->model) {
    impl_->copy(*from.impl_);
    return {};
  }
  auto changed = impl_->of(from.impl_->model);
  if (!changed) return Error{changed.error()};
  changed.value()->copy(*from.impl_);
  impl_ = std::move(changed).value();
  return {};
}

std::vector<std::byte> Cloth::save_state() const { return weft::save_state(*impl_); }

Result<void> Cloth::load_state(std::span<const std::byte> bytes) {
  auto saved = weft::read_state(bytes, *impl_->model);
  if (!saved) return Error{saved.error()};
  const bool had_bodies = saved.value().lasting.bodies.were_any();
  auto next = had_bodies ? impl_->for_bodies() : impl_->of(impl_->model);
  if (!next) return Error{next.error()};
  if (auto r = restore(*next.value(), std::move(saved).value()); !r) return r;
  impl_ = std::move(next).value();
  return {};
}

Result<void> Cloth::change(const Changes& changes) {
  if (auto valid = validate(changes, *impl_->model); !valid) return valid;
  if (is_empty(changes)) return {};
  auto changed = impl_->going_on(weft::changed(*impl_->model, changes));
  if (!changed) return Error{changed.error()};
  impl_ = std::move(changed).value();
  return {};
}

Result<StepReport> Cloth::step(double dt, const JobSystem& jobs) {
  if (auto valid = validate_time_step(dt); !valid) return Error{valid.error()};
  if (auto valid = validate(jobs); !valid) return Error{valid.error()};
  return step_in_team(*impl_, dt, jobs);
}

State* Cloth::state() { return impl_.get(); }

std::size_t Cloth::particle_count() const { return impl_->model->particles; }
const std::shared_ptr<const Model>& Cloth::model() const { return impl_->model; }
const Settings& Cloth::settings() const { return impl_->settings; }

Vec3 Cloth::position(std::uint32_t particle) const {
  return to_public(impl_->position[impl_->slot(particle)]);
}
Vec3 Cloth::velocity(std::uint32_t particle) const {
  return to_public(impl_->velocity[impl_->slot(particle)]);
}

Result<void> Cloth::read_positions(std::span<Vec3> out) const {
  return read(*impl_->model, impl_->position, out);
}
Result<void> Cloth::read_velocities(std::span<Vec3> out) const {
  return read(*impl_->model, impl_->velocity, out);
}

Result<void> Cloth::read_positions(FloatVectors out, Vec3 origin) const {
  if (auto r = validate_origin(origin); !r) return r;
  return read(*impl_->model, impl_->position, out, to_internal(origin));
}
Result<void> Cloth::read_velocities(FloatVectors out) const {
  return read(*impl_->model, impl_->velocity, out, {0, 0, 0});
}

Bounds Cloth::bounds() const {
  Bounds bounds{position(0), position(0)};
  for (const std::uint32_t slot : impl_->model->ordering.slot_of) {
    const kernels::Vector x = impl_->position[slot];
    bounds.least = {std::min(bounds.least.x, x.x), std::min(bounds.least.y, x.y),
                    std::min(bounds.least.z, x.z)};
    bounds.most = {std::max(bounds.most.x, x.x), std::max(bounds.most.y, x.y),
                   std::max(bounds.most.z, x.z)};
  }
  return bounds;
}

Result<void> Cloth::write_positions(std::span<const Vec3> in) {
  if (auto r = validate_vectors("positions", in, particle_count()); !r) return r;
  for (std::uint32_t i = 0; i < in.size(); ++i) {
    impl_->position.set(impl_->slot(i), to_internal(in[i]));
  }
  impl_->rest.wake();
  impl_->pins.put_down(impl_->position);
  impl_->anchors.put_down();
  impl_->placed = true;
  impl_->lost_energy = 0;
  impl_->refinement = 0;
  return {};
}

Result<void> Cloth::write_velocities(std::span<const Vec3> in) {
  if (auto r = validate_vectors("velocities", in, particle_count()); !r) return r;
  for (std::uint32_t i = 0; i < in.size(); ++i) {
    const std::uint32_t slot = impl_->slot(i);
    const bool fixed = impl_->model->inverse_mass[slot] == 0;
    impl_->velocity.set(slot, fixed ? kernels::Vector{0, 0, 0} : to_internal(in[i]));
  }
  impl_->rest.wake();
  impl_->pins.rest();
  return {};
}

Result<void> Cloth::write_forces(std::span<const Vec3> in) {
  if (in.empty()) {
    if (impl_->force.size() > 0) impl_->rest.wake();
    impl_->force.resize(0);
    return {};
  }
  if (auto r = validate_vectors("forces", in, particle_count()); !r) return r;
  if (impl_->force.size() == 0) impl_->force = kernels::Vectors(impl_->model->slots());
  for (std::uint32_t i = 0; i < in.size(); ++i) {
    set(impl_->force, impl_->slot(i), in[i], impl_->rest);
  }
  return {};
}

Result<void> Cloth::set_gravity(Vec3 gravity) {
  if (auto r = validate_gravity(gravity); !r) return r;
  set(impl_->gravity, gravity, impl_->rest);
  return {};
}

Result<void> Cloth::set_wind(Vec3 wind) {
  if (auto r = validate_wind(wind); !r) return r;
  set(impl_->wind, wind, impl_->rest);
  return {};
}

Result<void> Cloth::move_fixed(std::uint32_t particle, Vec3 position) {
  if (auto r = impl_->validate_pin("particle", particle); !r) return r;
  if (auto r = validate_vector("position", particle, position); !r) return r;
  return move_fixed({&particle, 1}, {&position, 1});
}

Result<void> Cloth::move_fixed(std::span<const std::uint32_t> particles,
                               std::span<const Vec3> positions) {
  if (auto r = impl_->validate_pins(particles, positions); !r) return r;
  if (particles.empty()) return {};
  impl_->pins.watch(*impl_->model, impl_->position);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    set(impl_->position, impl_->slot(particles[i]), positions[i], impl_->rest);
  }
  return {};
}

Result<void> Cloth::place_fixed(std::uint32_t particle, Vec3 position) {
  if (auto r = impl_->validate_pin("particle", particle); !r) return r;
  if (auto r = validate_vector("position", particle, position); !r) return r;
  return place_fixed({&particle, 1}, {&position, 1});
}

Result<void> Cloth::place_fixed(std::span<const std::uint32_t> particles,
                                std::span<const Vec3> positions) {
  if (auto r = impl_->validate_pins(particles, positions); !r) return r;
  if (particles.empty()) return {};
  impl_->pins.put_down(*impl_->model, particles, positions, impl_->position);
  impl_->displaced = true;
  impl_->rest.wake();
  return {};
}

Result<void> Cloth::move_anchors(std::span<const Vec3> points, std::span<const Vec3> normals) {
  if (auto r = validate_anchor_move(*impl_->model, points, normals); !r) return r;
  impl_->anchors.move(points, normals);
  if (impl_->anchors.moving()) impl_->rest.wake();
  return {};
}

Result<void> Cloth::limit_anchors(std::span<const AnchorLimit> limits) {
  const Model& model = *impl_->model;
  if (auto r = validate_anchor_limits(model, limits); !r) return r;
  bool changes_sides = false;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const bool was_attached = model.anchors.limits[i].most == 0;
    changes_sides = changes_sides || was_attached != (limits[i].max_distance == 0);
  }
  if (changes_sides) {
    auto changed = impl_->going_on(with_anchor_distances(model, limits));
    if (!changed) return Error{changed.error()};
    impl_ = std::move(changed).value();
  }
  const auto same = [](const AnchorLimit& a, const AnchorLimit& b) {
    return a.max_distance == b.max_distance && a.backstop == b.backstop;
  };
  if (!std::ranges::equal(limits, impl_->anchors.limits(), same)) impl_->rest.wake();
  impl_->anchors.limit(limits);
  return {};
}

Result<void> Cloth::limit_anchor(std::uint32_t anchor, const AnchorLimit& limit) {
  if (auto r = validate_anchor_limit(*impl_->model, anchor, limit); !r) return r;
  std::vector<AnchorLimit> limits = impl_->anchors.limits();
  limits[anchor] = limit;
  return limit_anchors(limits);
}

Result<void> Cloth::scale_anchors(double scale) {
  if (auto r = validate_not_negative("scale", scale); !r) return r;
  impl_->anchors.scale(scale);
  if (impl_->anchors.moving()) impl_->rest.wake();
  return {};
}

Result<void> Cloth::prepare_for_bodies() {
  if (impl_->settings.solver == Solver::small_steps) return {};
  auto changed = impl_->for_bodies();
  if (!changed) return Error{changed.error()};
  changed.value()->go_on_from(*impl_);
  impl_ = std::move(changed).value();
  return {};
}

Result<std::uint32_t> Cloth::add_body(const Body& body) {
  if (auto valid = validate(body); !valid) return Error{valid.error()};
  if (auto prepared = prepare_for_bodies(); !prepared) return Error{prepared.error()};
  impl_->rest.wake();
  return impl_->bodies.add(body);
}

Result<void> Cloth::move_body(std::uint32_t id, const Pose& pose) {
  if (auto r = impl_->validate_body(id); !r) return r;
  if (auto r = validate(pose); !r) return r;
  if (impl_->bodies.move(id, pose)) impl_->rest.wake();
  return {};
}

Result<void> Cloth::place_body(std::uint32_t id, const Pose& pose) {
  if (auto r = impl_->validate_body(id); !r) return r;
  if (auto r = validate(pose); !r) return r;
  if (impl_->bodies.place(id, pose)) impl_->rest.wake();
  return {};
}

Result<void> Cloth::Impl::validate_vertices(std::uint32_t id,
                                            std::span<const Vec3> vertices) const {
  if (auto r = validate_body(id); !r) return r;
  const std::size_t count = bodies.vertices(id);
  if (count == 0) return refuse("body", "is no triangle mesh", std::to_string(id));
  if (vertices.size() != count)
    return refuse("vertices", "must be as many as the mesh has, " + std::to_string(count),
                  std::to_string(vertices.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(vertices[i]))
      return refuse(element("vertices", i), "must be finite", text(vertices[i]));
  }
  return {};
}

Result<void> Cloth::move_body_vertices(std::uint32_t id, std::span<const Vec3> vertices) {
  if (auto r = impl_->validate_vertices(id, vertices); !r) return r;
  if (impl_->bodies.move_vertices(id, vertices)) impl_->rest.wake();
  return {};
}

Result<void> Cloth::place_body_vertices(std::uint32_t id, std::span<const Vec3> vertices) {
  if (auto r = impl_->validate_vertices(id, vertices); !r) return r;
  if (impl_->bodies.place_vertices(id, vertices)) impl_->rest.wake();
  return {};
}

Result<void> Cloth::switch_body(std::uint32_t id, bool on) {
  if (auto r = impl_->validate_body(id); !r) return r;
  if (impl_->bodies.switch_on(id, on)) impl_->rest.wake();
  return {};
}

Result<void> Cloth::remove_body(std::uint32_t id) {
  if (auto r = impl_->validate_body(id); !r) return r;
  impl_->bodies.remove(id);
  impl_->rest.wake();
  return {};
}

Result<BodyLoad> Cloth::body_load(std::uint32_t id) const {
  if (auto r = impl_->validate_body(id); !r) return Error{r.error()};
  return impl_->bodies.load(id);
}

std::vector<BodyContact> Cloth::body_contacts() const {
  std::vector<BodyContact> contacts;
  if (impl_->settings.solver != Solver::small_steps) return contacts;
  std::vector<BodyTouch> touches;
  impl_->small_steps->read_contacts(touches);
  for (const BodyTouch& touch : touches) {
    contacts.push_back({.particle = impl_->model->ordering.particle_at[touch.slot],
                        .body = touch.body,
                        .point = to_public(touch.point),
                        .normal = to_public(touch.normal),
                        .push = touch.push});
  }
  return contacts;
}

Result<void> Cloth::carry(const RigidMotion& motion, double share) {
  if (auto r = validate_motion(motion, share); !r) return r;
  if (share == 0 || is_identity(motion)) return {};
  if (auto r = impl_->take_along(motion, share); !r) return r;
  impl_->way.add(motion, share);
  return {};
}

Result<void> Cloth::teleport(const RigidMotion& motion) {
  if (auto r = validate_motion(motion, 1); !r) return r;
  return impl_->take_along(motion, 1);
}

Result<void> Cloth::Impl::take_along(const RigidMotion& motion, double share) {
  rest.wake();
  const std::uint32_t lost = weft::carry(*this, Carriage(motion, share));
  if (lost == kNoIndex) return {};
  return Error{"motion: takes a particle out of the range of numbers (" +
               std::to_string(model->ordering.particle_at[lost]) + ")"};
}

Strain Cloth::strain() const {
  Strain strain = measure_strain(*impl_->model, impl_->position);
  add_membrane_strain(*impl_->model, impl_->position, strain);
  return strain;
}
double Cloth::max_penetration() const {
  return weft::max_penetration(*impl_->model, *impl_->kernels, impl_->position.view(),
                               impl_->contacts);
}
Energy Cloth::energy() const {
  return measure_energy(*impl_->model, impl_->gravity, impl_->position, impl_->velocity,
                        impl_->give_per_mass);
}

std::uint64_t Cloth::state_hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  hash_bits(hash, *impl_->model, impl_->position);
  hash_bits(hash, *impl_->model, impl_->velocity);
  return hash;
}

std::size_t Cloth::bytes() const { return impl_->bytes(); }

}  // namespace weft
