#include "engine/c_interface/scene_arrays.h"

#include <weft/scene_fields.h>

#include <cstring>
#include <type_traits>

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/parts.h"
#include "engine/c_interface/pressure_structs.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

using Triple = std::array<std::uint32_t, 3>;

// ------------------------------------------------------------------------------ arrays of elements

/// Where a field stands in an item of its array, and how long the item is, in numbers.
struct Share {
  std::size_t at = 0, length = 0;
};

template <class Element, class Value, class Number>
Share share_of(const ElementField<Element, Value, Number>& field) {
  static_assert(kConsistsOf<Value, Number>);
  Share share;
  for_each_element_field<Element>([&]<class V, class N>(const ElementField<Element, V, N>& other) {
    if constexpr (std::is_same_v<N, Number>) {
      if (other.array != field.array) return;
      if (static_cast<const void*>(&other) == &field) share.at = share.length;
      share.length += sizeof(V) / sizeof(N);
    }
  });
  return share;
}

template <class Element>
void read_elements(const ElementKind<Element>& kind, const weft_scene& s, Arrays& in,
                   SceneDescription& out) {
  const std::size_t count = s.*kind.count_in_c;
  for_each_element_field<Element>([&]<class V, class N>(const ElementField<Element, V, N>& field) {
    if (field.given_in_c == Given::always)
      in.needed<N>(field.name_in_c, s.*field.array, count);
    else
      in.optional<N>(field.name_in_c, s.*field.array, count);
  });
  if (!in.are_good()) return;
  std::vector<Element>& list = out.*kind.list;
  list.resize(count);
  for_each_element_field<Element>([&]<class V, class N>(const ElementField<Element, V, N>& field) {
    const N* numbers = s.*field.array;
    if (numbers == nullptr) return;
    const auto [at, length] = share_of(field);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(static_cast<void*>(&(list[i].*field.member)), numbers + i * length + at,
                  sizeof(V));
  });
}

template <class Element>
void add_arrays(const std::vector<Element>& list, SceneArrays& arrays) {
  for_each_element_field<Element>([&]<class V, class N>(const ElementField<Element, V, N>& field) {
    auto& all = std::get<std::vector<std::vector<N>>>(arrays.elements);
    const auto [at, length] = share_of(field);
    if (at == 0) all.emplace_back(list.size() * length);
    for (std::size_t i = 0; i < list.size(); ++i)
      std::memcpy(all.back().data() + i * length + at, &(list[i].*field.member), sizeof(V));
  });
}

void write_elements(const SceneDescription& scene, const SceneArrays& arrays, weft_scene& out) {
  std::tuple iterators{std::get<0>(arrays.elements).begin(), std::get<1>(arrays.elements).begin(),
                       std::get<2>(arrays.elements).begin()};
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    out.*kind.count_in_c = (scene.*kind.list).size();
    for_each_element_field<Element>(
        [&]<class V, class N>(const ElementField<Element, V, N>& field) {
          using Iterator = typename std::vector<std::vector<N>>::const_iterator;
          if (share_of(field).at == 0) out.*field.array = (std::get<Iterator>(iterators)++)->data();
        });
  });
}

// ------------------------------------------------------------------------------------- the rest

void read_particles(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.particle_count;
  out.positions = list_of(in.needed<Vec3>("positions", s.positions, n));
  out.velocities = list_of(in.optional<Vec3>("velocities", s.velocities, n));
  out.masses = list_of(in.needed<double>("masses", s.masses, n));
  out.fixed = list_of(in.needed<std::uint32_t>("fixed", s.fixed, s.fixed_count));
  out.rail_particles =
      list_of(in.needed<std::uint32_t>("rail_particles", s.rail_particles, s.rail_particle_count));
  out.spheres = list_of(in.needed<std::uint32_t>("spheres", s.spheres, s.sphere_count));
  out.radii = list_of(in.optional<double>("radii", s.radii, n));
}

void read_world(const weft_scene& s, Arrays& in, SceneDescription& out) {
  out.surface =
      list_of(in.needed<Triple>("surface_triangles", s.surface_triangles, s.surface_count));
  out.air.triangles =
      list_of(in.needed<Triple>("air_triangles", s.air_triangles, s.air_triangle_count));
  read_part(s, out.damping);
  read_part(s, out.air);
  read_part(s, out.self_contact);
  read_part(s, out);
}

void write_world(const SceneDescription& scene, weft_scene& out) {
  write_part(scene.damping, out);
  write_part(scene.air, out);
  write_part(scene.self_contact, out);
  write_part(scene, out);
}

}  // namespace

weft_scene default_scene() {
  weft_scene scene{};
  scene.size = sizeof scene;
  write_world(SceneDescription{}, scene);
  return scene;
}

Result<SceneDescription> read_scene(const weft_scene* scene) {
  const auto s = read_struct("scene", scene, default_scene());
  if (!s) return Error{s.error()};
  Arrays in;
  SceneDescription out;
  read_particles(s.value(), in, out);
  for_each_element_kind([&](const auto& kind) { read_elements(kind, s.value(), in, out); });
  read_world(s.value(), in, out);
  if (!in.are_good()) return in.error();
  auto pressures = read_pressures(s.value().pressure_count, s.value().pressures);
  if (!pressures) return Error{pressures.error()};
  out.pressures = std::move(pressures).value();
  return out;
}

SceneArrays arrays_of(const SceneDescription& scene) {
  SceneArrays a;
  for_each_element_kind([&](const auto& kind) { add_arrays(scene.*kind.list, a); });
  for (const Pressure& part : scene.pressures) a.pressures.push_back(pressure_of(part));
  return a;
}

weft_scene scene_of(const SceneDescription& scene, const SceneArrays& arrays) {
  weft_scene out = default_scene();
  out.particle_count = scene.positions.size();
  out.positions = as_numbers<double>(scene.positions);
  out.velocities = scene.velocities.empty() ? nullptr : as_numbers<double>(scene.velocities);
  out.masses = scene.masses.data();
  out.fixed_count = scene.fixed.size();
  out.fixed = scene.fixed.data();
  out.rail_particle_count = scene.rail_particles.size();
  out.rail_particles = scene.rail_particles.data();
  write_elements(scene, arrays, out);
  out.surface_count = scene.surface.size();
  out.surface_triangles = as_numbers<std::uint32_t>(scene.surface);
  out.pressure_count = arrays.pressures.size();
  out.pressures = arrays.pressures.data();
  out.air_triangle_count = scene.air.triangles.size();
  out.air_triangles = as_numbers<std::uint32_t>(scene.air.triangles);
  write_world(scene, out);
  out.sphere_count = scene.spheres.size();
  out.spheres = scene.spheres.data();
  out.radii = scene.radii.empty() ? nullptr : scene.radii.data();
  return out;
}

}  // namespace weft::c_interface
