/// Values of a cloth are read, written and measured.
#include <algorithm>

#include "engine/cpp_interface/cloth_impl.h"
#include "engine/measure/state_measure.h"
#include "engine/model/pressures.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/pressure.h"
#include "engine/step/state_hash.h"
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

}  // namespace

Vec3 Cloth::position(std::uint32_t particle) const {
  return to_public(impl_->state.position[impl_->slot(particle)]);
}
Vec3 Cloth::velocity(std::uint32_t particle) const {
  return to_public(impl_->state.velocity[impl_->slot(particle)]);
}

Result<void> Cloth::read_positions(std::span<Vec3> out) const {
  return read(*impl_->state.model, impl_->state.position, out);
}
Result<void> Cloth::read_velocities(std::span<Vec3> out) const {
  return read(*impl_->state.model, impl_->state.velocity, out);
}

Result<void> Cloth::read_positions(FloatVectors out, Vec3 origin) const {
  if (auto r = validate_origin(origin); !r) return r;
  return read(*impl_->state.model, impl_->state.position, out, to_internal(origin));
}
Result<void> Cloth::read_velocities(FloatVectors out) const {
  return read(*impl_->state.model, impl_->state.velocity, out, {0, 0, 0});
}

Bounds Cloth::bounds() const {
  Bounds bounds{position(0), position(0)};
  for (const std::uint32_t slot : impl_->state.model->ordering.slot_of) {
    const kernels::Vector x = impl_->state.position[slot];
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
    impl_->state.position.set(impl_->slot(i), to_internal(in[i]));
  }
  impl_->state.wake();
  impl_->state.pins.teleport(impl_->state.position);
  impl_->state.anchors.teleport();
  impl_->state.placed = true;
  impl_->state.lost_energy = 0;
  impl_->state.refinement = 0;
  return {};
}

Result<void> Cloth::write_velocities(std::span<const Vec3> in) {
  if (auto r = validate_vectors("velocities", in, particle_count()); !r) return r;
  for (std::uint32_t i = 0; i < in.size(); ++i) {
    const std::uint32_t slot = impl_->slot(i);
    const bool fixed = impl_->state.model->inverse_mass[slot] == 0;
    impl_->state.velocity.set(slot, fixed ? kernels::Vector{0, 0, 0} : to_internal(in[i]));
  }
  impl_->state.wake();
  impl_->state.pins.rest();
  return {};
}

Result<void> Cloth::write_forces(std::span<const Vec3> in) {
  if (in.empty()) {
    if (impl_->state.force.size() > 0) impl_->state.wake();
    impl_->state.force.resize(0);
    return {};
  }
  if (auto r = validate_vectors("forces", in, particle_count()); !r) return r;
  if (impl_->state.force.size() == 0)
    impl_->state.force = kernels::Vectors(impl_->state.model->slots());
  for (std::uint32_t i = 0; i < in.size(); ++i) {
    impl_->set(impl_->state.force, i, in[i]);
  }
  return {};
}

Result<void> Cloth::set_gravity(Vec3 gravity) {
  if (auto r = validate_gravity(gravity); !r) return r;
  impl_->set(impl_->state.gravity, gravity);
  return {};
}

Result<void> Cloth::set_wind(Vec3 wind) {
  if (auto r = validate_wind(wind); !r) return r;
  impl_->set(impl_->state.wind, wind);
  return {};
}

Result<void> Cloth::set_pressure(double pressure) {
  if (pressure == 0) return set_pressure(std::span<const Pressure>{});
  const Pressure everywhere{.pressure = pressure};
  return set_pressure({&everywhere, 1});
}

Result<void> Cloth::set_pressure(std::span<const Pressure> pressures) {
  const auto place = [&](std::uint32_t slot) { return impl_->state.position[slot]; };
  const std::vector<SurfaceTriangle>& surface = impl_->state.model->surface;
  if (auto r = validate_pressures(pressures, impl_->state.pressures, surface, place); !r) return r;
  std::vector<Pressure> known = with_volumes(pressures, surface, place);
  if (known == impl_->state.pressures) return {};
  if (!known.empty()) {
    if (auto prepared = prepare_for("pressures"); !prepared) return prepared;
  }
  impl_->state.wake();
  impl_->state.gas = gas_going_on(impl_->state, known);
  impl_->state.pressures = std::move(known);
  impl_->state.make_room_for_pressure();
  return {};
}

std::vector<PressureNow> Cloth::pressures() const {
  std::vector<PressureNow> now;
  State& state = impl_->state;
  for (const Pressure& part : state.pressures)
    now.push_back(pressure_now(*state.model, part, state.position.view()));
  return now;
}

Strain Cloth::strain() const {
  Strain strain = measure_strain(*impl_->state.model, impl_->state.position);
  add_membrane_strain(*impl_->state.model, impl_->state.position, strain);
  return strain;
}
double Cloth::max_penetration() const {
  return weft::max_penetration(*impl_->state.model, *impl_->state.kernels,
                               impl_->state.position.view(), impl_->state.contacts);
}
Energy Cloth::energy() const {
  return measure_energy(*impl_->state.model, impl_->state.gravity, impl_->state.position,
                        impl_->state.velocity, impl_->state.creases.all(),
                        impl_->state.give_per_mass);
}

std::uint64_t Cloth::state_hash() const { return weft::state_hash(impl_->state); }

}  // namespace weft
