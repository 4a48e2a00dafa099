/// Cloths are made, copied, saved, changed and stepped.
#include <utility>

#include "engine/cpp_interface/cloth_impl.h"
#include "engine/isa.h"
#include "engine/model/change.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/recording/recorder.h"
#include "engine/step/choose_solver.h"
#include "engine/step/saved_state.h"
#include "engine/step/step_in_team.h"
#include "engine/step/validate_settings.h"
#include "engine/validation.h"

namespace weft {
namespace {

bool is_empty(const Changes& changes) {
  return changes.fix.empty() && changes.release.empty() && changes.masses.empty() &&
         changes.rest_lengths.empty() && changes.compliances.empty() && changes.membrane.empty() &&
         changes.bending.empty() && !changes.damping && !changes.air;
}

/// The settings used for a model: asked is valid in itself, and its isa is chosen.
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

Result<std::unique_ptr<Cloth::Impl>> Cloth::Impl::of(
    const std::shared_ptr<const Model>& other) const {
  auto resolved = resolve(asked, *other);
  if (!resolved) return Error{resolved.error()};
  return std::make_unique<Impl>(other, asked, resolved.value());
}

Result<std::unique_ptr<Cloth::Impl>> Cloth::Impl::going_on(
    const std::shared_ptr<const Model>& other) const {
  auto next = of(other);
  if (next) next.value()->state.go_on_from(state);
  return next;
}

Result<std::unique_ptr<Cloth::Impl>> Cloth::Impl::by_small_steps(std::string_view what) const {
  if (state.settings.solver == Solver::small_steps) return of(state.model);
  if (asked.solver != Solver::automatic)
    return refuse(what, "needs solver small_steps", std::string(name(state.settings.solver)));
  Settings wanted = asked;
  wanted.solver = Solver::small_steps;
  auto resolved = resolve(wanted, *state.model);
  if (!resolved) return Error{resolved.error()};
  return std::make_unique<Impl>(state.model, wanted, resolved.value());
}

void Cloth::Impl::set(kernels::Vector& to, Vec3 value) {
  const kernels::Vector from = std::exchange(to, to_internal(value));
  if (from.x != to.x || from.y != to.y || from.z != to.z) state.wake();
}

void Cloth::Impl::set(kernels::Vectors& vectors, std::uint32_t particle, Vec3 value) {
  kernels::Vector vector = vectors[slot(particle)];
  set(vector, value);
  vectors.set(slot(particle), vector);
}

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
  Cloth copy(std::make_unique<Impl>(impl_->state.model, impl_->asked, impl_->state.settings));
  copy.impl_->state.copy(impl_->state);
  return copy;
}

Result<void> Cloth::copy_state(const Cloth& from) {
  if (!are_related(*from.impl_->state.model, *impl_->state.model)) {
    return Error{"from: is a cloth of another model (" + std::to_string(from.particle_count()) +
                 " particles)"};
  }
  const State& other = from.impl_->state;
  if (other.bodies.any() || !other.pressures.empty()) {
    const char* what = other.bodies.any() ? "body" : "pressures";
    if (auto prepared = prepare_for(what); !prepared) return prepared;
  }
  if (from.impl_->state.model == impl_->state.model) {
    impl_->state.copy(from.impl_->state);
    return {};
  }
  auto changed = impl_->of(from.impl_->state.model);
  if (!changed) return Error{changed.error()};
  changed.value()->state.copy(from.impl_->state);
  impl_ = std::move(changed).value();
  return {};
}

std::vector<std::byte> Cloth::save_state() const { return weft::save_state(impl_->state); }

Result<void> Cloth::load_state(std::span<const std::byte> bytes) {
  auto saved = weft::read_state(bytes, *impl_->state.model);
  if (!saved) return Error{saved.error()};
  const LastingState& lasting = saved.value().lasting;
  const bool had_bodies = lasting.bodies.were_any();
  auto next = had_bodies || !lasting.pressures.empty()
                  ? impl_->by_small_steps(had_bodies ? "body" : "pressures")
                  : impl_->of(impl_->state.model);
  if (!next) return Error{next.error()};
  if (auto r = restore(next.value()->state, std::move(saved).value()); !r) return r;
  impl_ = std::move(next).value();
  return {};
}

Result<void> Cloth::change(const Changes& changes) {
  if (auto valid = validate(changes, *impl_->state.model); !valid) return valid;
  if (is_empty(changes)) return {};
  auto changed = impl_->going_on(weft::changed(*impl_->state.model, changes));
  if (!changed) return Error{changed.error()};
  impl_ = std::move(changed).value();
  return {};
}

Result<void> Cloth::set_rest_shape(const SceneDescription& scene, double scale) {
  const Model& model = *impl_->state.model;
  auto description = with_rest_shape(model, scene, scale);
  if (!description) return Error{description.error()};
  auto changed = impl_->going_on(rebuilt(model, description.value()));
  if (!changed) return Error{changed.error()};
  changed.value()->state.creases = Creases(*changed.value()->state.model);
  impl_ = std::move(changed).value();
  return {};
}

Result<StepReport> Cloth::step(double dt, const JobSystem& jobs) {
  if (auto valid = validate_time_step(dt); !valid) return Error{valid.error()};
  if (auto valid = validate(jobs); !valid) return Error{valid.error()};
  State& state = impl_->state;
  return recorded(recorder_.get(), state, dt, [&] { return step_in_team(state, dt, jobs); });
}

Result<void> Cloth::begin_recording(const std::string& path, std::string_view note) {
  if (recorder_) return refuse("path", "the cloth is being recorded already", in_one_line(path));
  auto begun = Recorder::begin(path, note, impl_->asked, impl_->state);
  if (!begun) return Error{begun.error()};
  recorder_ = std::move(begun).value();
  return {};
}

Result<void> Cloth::end_recording() {
  if (!recorder_) return Error{"recording: nothing is being recorded (none)"};
  return std::exchange(recorder_, nullptr)->end();
}

State* Cloth::state() { return impl_ ? &impl_->state : nullptr; }

Result<void> Cloth::prepare_for(std::string_view what) {
  if (impl_->state.settings.solver == Solver::small_steps) return {};
  auto changed = impl_->by_small_steps(what);
  if (!changed) return Error{changed.error()};
  changed.value()->state.go_on_from(impl_->state);
  impl_ = std::move(changed).value();
  return {};
}

std::size_t Cloth::particle_count() const { return impl_->state.model->particles; }
const std::shared_ptr<const Model>& Cloth::model() const { return impl_->state.model; }
const Settings& Cloth::settings() const { return impl_->state.settings; }

std::size_t Cloth::bytes() const {
  return impl_->state.bytes() + (recorder_ ? recorder_->bytes() : 0);
}

}  // namespace weft
