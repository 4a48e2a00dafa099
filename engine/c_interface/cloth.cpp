/// A cloth in C: made, read, written and measured.
#include "engine/c_interface/arrays.h"
#include "engine/c_interface/float_vectors.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/settings.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

weft_strain strain_of(const Strain& s) {
  return {.size = sizeof(weft_strain),
          .max = s.max,
          .rms = s.rms,
          .worst_constraint = s.worst_constraint,
          .max_shear = s.max_shear,
          .worst_element = s.worst_element};
}

weft_energy energy_of(const Energy& e) {
  return {.size = sizeof(weft_energy),
          .kinetic = e.kinetic,
          .potential = e.potential,
          .elastic = e.elastic};
}

Result<void> read_one(const weft_cloth* cloth, std::uint32_t particle, double* out,
                      Vec3 (Cloth::*read)(std::uint32_t) const) {
  if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
  if (particle >= cloth->cloth.particle_count()) {
    return Error{"particle: the cloth has " + std::to_string(cloth->cloth.particle_count()) + " (" +
                 std::to_string(particle) + ")"};
  }
  write_vector((cloth->cloth.*read)(particle), out);
  return {};
}

/// One Vec3 per particle, straight into the caller's array.
Result<void> read_all(const weft_cloth* cloth, std::size_t count, double* out,
                      Result<void> (Cloth::*read)(std::span<Vec3>) const) {
  if (auto r = given({{"cloth", cloth}}); !r) return r;
  Arrays arrays;
  arrays.needed<Vec3>("out", out, count);
  if (!arrays.are_good()) return arrays.error();
  return (cloth->cloth.*read)({reinterpret_cast<Vec3*>(out), count});
}

Result<void> write_all(weft_cloth* cloth, std::size_t count, const double* in,
                       Result<void> (Cloth::*write)(std::span<const Vec3>)) {
  if (auto r = given({{"cloth", cloth}}); !r) return r;
  Arrays arrays;
  const auto vectors = arrays.needed<Vec3>("in", in, count);
  if (!arrays.are_good()) return arrays.error();
  return (cloth->cloth.*write)(vectors);
}

Result<void> set(weft_cloth* cloth, std::string_view name, const double* vector,
                 Result<void> (Cloth::*write)(Vec3)) {
  if (auto r = given({{"cloth", cloth}, {name, vector}}); !r) return r;
  return (cloth->cloth.*write)(vector_of(vector));
}

}  // namespace

}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_strain(weft_strain* strain, size_t size) {
  return init_struct("strain", strain_of({}), strain, size);
}

weft_result weft_init_energy(weft_energy* energy, size_t size) {
  return init_struct("energy", energy_of({}), energy, size);
}

weft_result weft_create_cloth(const weft_model* model, const weft_settings* settings,
                              weft_cloth** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"model", model}, {"out", out}}); !r) return r;
    const auto read = read_settings(settings);
    if (!read) return weft::Error{read.error()};
    return hand_over(weft::Cloth::create(model->model, read.value()), out);
  });
}

void weft_free_cloth(weft_cloth* cloth) { delete cloth; }

weft_result weft_clone_cloth(const weft_cloth* cloth, weft_cloth** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
    *out = new weft_cloth{cloth->cloth.clone()};
    return {};
  });
}

weft_result weft_copy_state(weft_cloth* to, const weft_cloth* from) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"to", to}, {"from", from}}); !r) return r;
    return to->cloth.copy_state(from->cloth);
  });
}

weft_result weft_save_state(const weft_cloth* cloth, weft_bytes** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
    *out = new weft_bytes{cloth->cloth.save_state()};
    return {};
  });
}

weft_result weft_load_state(weft_cloth* cloth, const void* bytes, size_t size) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"bytes", bytes}}); !r) return r;
    return cloth->cloth.load_state({static_cast<const std::byte*>(bytes), size});
  });
}

weft_result weft_begin_recording(weft_cloth* cloth, const char* path, const char* note) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"path", path}}); !r) return r;
    return cloth->cloth.begin_recording(path, note == nullptr ? "" : note);
  });
}

weft_result weft_end_recording(weft_cloth* cloth) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.end_recording();
  });
}

size_t weft_particle_count(const weft_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.particle_count(); });
}

weft_result weft_model_of(const weft_cloth* cloth, weft_model** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
    *out = new weft_model{cloth->cloth.model()};
    return {};
  });
}

weft_result weft_settings_of(const weft_cloth* cloth, weft_settings* settings) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("settings", settings); !r) return r;
    write_struct(settings_of(cloth->cloth.settings()), settings);
    return {};
  });
}

weft_result weft_position(const weft_cloth* cloth, uint32_t particle, double out[3]) {
  return call([&] { return read_one(cloth, particle, out, &weft::Cloth::position); });
}

weft_result weft_velocity(const weft_cloth* cloth, uint32_t particle, double out[3]) {
  return call([&] { return read_one(cloth, particle, out, &weft::Cloth::velocity); });
}

weft_result weft_read_positions(const weft_cloth* cloth, size_t count, double* out) {
  return call([&] { return read_all(cloth, count, out, &weft::Cloth::read_positions); });
}

weft_result weft_read_velocities(const weft_cloth* cloth, size_t count, double* out) {
  return call([&] { return read_all(cloth, count, out, &weft::Cloth::read_velocities); });
}

weft_result weft_read_float_positions(const weft_cloth* cloth, weft_float_vectors out,
                                      const double origin[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const auto floats = float_vectors("out", out);
    if (!floats) return weft::Error{floats.error()};
    return cloth->cloth.read_positions(floats.value(), vector_of(origin));
  });
}

weft_result weft_read_float_velocities(const weft_cloth* cloth, weft_float_vectors out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const auto floats = float_vectors("out", out);
    if (!floats) return weft::Error{floats.error()};
    return cloth->cloth.read_velocities(floats.value());
  });
}

weft_result weft_bounds(const weft_cloth* cloth, double least[3], double most[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"least", least}, {"most", most}}); !r) return r;
    const weft::Bounds bounds = cloth->cloth.bounds();
    write_vector(bounds.least, least);
    write_vector(bounds.most, most);
    return {};
  });
}

weft_result weft_write_positions(weft_cloth* cloth, size_t count, const double* in) {
  return call([&] { return write_all(cloth, count, in, &weft::Cloth::write_positions); });
}

weft_result weft_write_velocities(weft_cloth* cloth, size_t count, const double* in) {
  return call([&] { return write_all(cloth, count, in, &weft::Cloth::write_velocities); });
}

weft_result weft_write_forces(weft_cloth* cloth, size_t count, const double* in) {
  return call([&] { return write_all(cloth, count, in, &weft::Cloth::write_forces); });
}

weft_result weft_set_gravity(weft_cloth* cloth, const double gravity[3]) {
  return call([&] { return set(cloth, "gravity", gravity, &weft::Cloth::set_gravity); });
}

weft_result weft_set_wind(weft_cloth* cloth, const double wind[3]) {
  return call([&] { return set(cloth, "wind", wind, &weft::Cloth::set_wind); });
}

weft_result weft_strain_of(const weft_cloth* cloth, weft_strain* strain) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("strain", strain); !r) return r;
    write_struct(strain_of(cloth->cloth.strain()), strain);
    return {};
  });
}

weft_result weft_energy_of(const weft_cloth* cloth, weft_energy* energy) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("energy", energy); !r) return r;
    write_struct(energy_of(cloth->cloth.energy()), energy);
    return {};
  });
}

double weft_max_penetration(const weft_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.max_penetration(); });
}

uint64_t weft_state_hash(const weft_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.state_hash(); });
}

size_t weft_cloth_bytes(const weft_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.bytes(); });
}
