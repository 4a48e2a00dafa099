/// The fields of public structures, for archives.
#pragma once

#include <weft/report_fields.h>
#include <weft/scene_fields.h>
#include <weft/shape_fields.h>
#include <weft/weft.h>

#include <tuple>
#include <type_traits>

#include "engine/saving/archive.h"

namespace weft {

void visit_fields(Is<Vec3> auto& v, auto& archive) {
  auto& [x, y, z] = v;
  archive(x, y, z);
}

// scene.h

template <class T>
concept SceneElement = std::tuple_size_v<decltype(kElementFields<std::remove_const_t<T>>)> >
0;

void visit_fields(SceneElement auto& element, auto& archive) {
  using Its = std::remove_cvref_t<decltype(element)>;
  for_each_element_field<Its>([&](const auto& field) { archive(element.*field.member); });
}

template <class T>
concept ScenePart = !Is<T, SceneDescription> &&
                    std::tuple_size_v<decltype(kPartFields<std::remove_const_t<T>>)> > 0;

void visit_fields(ScenePart auto& part, auto& archive) {
  using Its = std::remove_cvref_t<decltype(part)>;
  for_each_part_field<Its>([&](const auto& field) { archive(part.*field.member); });
}

void visit_fields(Is<SceneDescription> auto& scene, auto& archive) {
  archive(scene.positions, scene.velocities, scene.masses, scene.fixed, scene.surface,
          scene.damping, scene.air, scene.pressures, scene.self_contact, scene.spheres, scene.radii,
          scene.rail_particles);
  for_each_element_kind([&](const auto& kind) { archive(scene.*kind.list); });
  for_each_part_field<SceneDescription>([&](const auto& field) { archive(scene.*field.member); });
}
/// Kinds of elements, and values of the scene itself.
inline constexpr std::uint32_t kListedInScenes =
    std::tuple_size_v<decltype(kElementKinds)> +
    std::tuple_size_v<decltype(kPartFields<SceneDescription>)>;
/// Fields of all kinds of elements.
template <class... Element>
constexpr std::uint32_t count_fields(const std::tuple<ElementKind<Element>...>&) {
  return static_cast<std::uint32_t>((std::tuple_size_v<decltype(kElementFields<Element>)> + ...));
}
inline constexpr std::uint32_t kListedInElements = count_fields(kElementKinds);
static_assert(detail::has_fields<SceneDescription, 12 + kListedInScenes>(),
              "a field of SceneDescription is not saved");

// body.h

void visit_fields(Is<Rotation> auto& rotation, auto& archive) {
  auto& [x, y, z, w] = rotation;
  archive(x, y, z, w);
}

void visit_fields(Is<Pose> auto& pose, auto& archive) {
  auto& [position, rotation] = pose;
  archive(position, rotation);
}

void visit_fields(Is<BodyLoad> auto& load, auto& archive) {
  auto& [force, moment] = load;
  archive(force, moment);
}

void visit_fields(Is<BodyMass> auto& mass, auto& archive) {
  auto& [amount, centre, inertia] = mass;
  archive(amount, centre, inertia);
}

// settings.h

void visit_fields(Is<Settings> auto& settings, auto& archive) {
  auto& [tolerance, substeps, iterations, max_iterations, contact_tolerance, velocity_tolerance,
         motion_tolerance, solver, scheme, backend, isa, threads, sleep, velocity_correction,
         measuring] = settings;
  auto& [directions, renew_after, anticipate, anticipate_products, skip, impulse_limit] = measuring;
  archive(tolerance, substeps, iterations, renew_after, max_iterations, contact_tolerance,
          velocity_tolerance, motion_tolerance, impulse_limit, solver, scheme, backend, isa,
          threads, directions, anticipate, anticipate_products, sleep, skip, velocity_correction);
}

// cloth.h

void visit_fields(Is<AnchorLimit> auto& limit, auto& archive) {
  auto& [max_distance, backstop] = limit;
  archive(max_distance, backstop);
}

void visit_fields(Is<ContactMs> auto& ms, auto& archive) {
  auto& [find, sweep, verify] = ms;
  archive(find, sweep, verify);
}

void visit_fields(Is<StepReport> auto& report, auto& archive) {
  for_each_report_field([&](const auto& field) { archive(report.*field.member); });
}

}  // namespace weft
