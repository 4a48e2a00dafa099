/// The kinds of elements of a scene, and their fields, as one list each, for code that treats all
/// of them alike: that checks, writes, reads or compares scenes. weft.h does not include it. A new
/// kind needs a struct and a list in scene.h, arrays in weft_c.h, and its list of fields here.
///
///   weft::for_each_element_kind([&]<class Element>(const weft::ElementKind<Element>& kind) {
///     for (const Element& element : scene.*kind.list)
///       weft::for_each_element_field<Element>(
///           [&](const auto& field) { print(field.name, element.*field.member); });
///   });
#pragma once

#include <weft/report_fields.h>
#include <weft/scene.h>
#include <weft/weft_c.h>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace weft {

/// The values that a field may have. Infinite ones are null in a scene file.
enum class Values : std::uint8_t {
  finite,
  positive,
  positive_or_infinite,
  squared,  ///< 1e-150 to 1e150
  not_negative,
  not_negative_or_infinite,
  particle,  ///< a particle of the scene
  kind,      ///< a ConstraintKind
  ruled      ///< A rule of the element says it (engine/model/validate_elements.cpp).
};

/// Whether a field may be left out. Then it has its default. (A scene file may leave out all values
/// of the scene itself; those that are `always` here are always written.)
enum class Given : std::uint8_t { always, maybe };

template <class Element, class Value, class Number>
struct ElementField {
  constexpr ElementField(const char* its_name, Value Element::*its_member, Values its_values,
                         Given is_given, const char* its_name_in_c,
                         const Number* weft_scene::*its_array, Given is_given_in_c = Given::always)
      : name(its_name),
        member(its_member),
        values(its_values),
        given(is_given),
        name_in_c(its_name_in_c),
        array(its_array),
        given_in_c(is_given_in_c) {}

  const char* name;
  Value Element::*member;
  Values values;
  Given given;  ///< in a scene file
  /// The array in C. Fields in a row with the same array stand in it one after the other.
  const char* name_in_c;
  const Number* weft_scene::*array;
  Given given_in_c;  ///< maybe: the array may be NULL
};

/// A field of a part of a scene that is no list of elements, such as its Damping, of the scene
/// itself, or of the counts of a model.
template <class Part, class Value, class InC>
struct PartField {
  constexpr PartField(const char* its_name, Value Part::*its_member, Values its_values,
                      InC its_in_c, const char* its_text, Given is_given = Given::maybe)
      : name(its_name),
        member(its_member),
        values(its_values),
        in_c(its_in_c),
        text(its_text),
        given(is_given) {}

  const char* name;
  Value Part::*member;
  Values values;
  InC in_c;          ///< the member of its struct there; nullptr: an array and its count
  const char* text;  ///< in a few words
  Given given;       ///< in a scene file
};

template <class Element>
struct ElementKind {
  constexpr ElementKind(const char* its_name, const char* its_type,
                        std::vector<Element> SceneDescription::*its_list,
                        std::size_t weft_scene::*its_count)
      : name(its_name), type(its_type), list(its_list), count_in_c(its_count) {}

  const char* name;  ///< of its list in a description
  const char* type;
  std::vector<Element> SceneDescription::*list;
  std::size_t weft_scene::*count_in_c;
};

/// The fields of an element, in the order in which its struct declares them.
template <class Element>
inline constexpr std::tuple<> kElementFields{};

template <>
inline constexpr std::tuple kElementFields<Constraint>{
    ElementField{"a", &Constraint::a, Values::particle, Given::always, "constraint_particles",
                 &weft_scene::constraint_particles},
    ElementField{"b", &Constraint::b, Values::particle, Given::always, "constraint_particles",
                 &weft_scene::constraint_particles},
    ElementField{"rest_length", &Constraint::rest_length, Values::squared, Given::always,
                 "rest_lengths", &weft_scene::rest_lengths},
    ElementField{"kind", &Constraint::kind, Values::kind, Given::maybe, "constraint_kinds",
                 &weft_scene::constraint_kinds, Given::maybe},
    ElementField{"compliance", &Constraint::compliance, Values::not_negative, Given::maybe,
                 "compliances", &weft_scene::compliances, Given::maybe},
    ElementField{"strength", &Constraint::strength, Values::not_negative_or_infinite, Given::maybe,
                 "constraint_strengths", &weft_scene::constraint_strengths, Given::maybe},
};

template <>
inline constexpr std::tuple kElementFields<MembraneElement>{
    ElementField{"particles", &MembraneElement::particles, Values::ruled, Given::always,
                 "membrane_particles", &weft_scene::membrane_particles},
    ElementField{"rest", &MembraneElement::rest, Values::ruled, Given::always, "membrane_rest",
                 &weft_scene::membrane_rest},
    ElementField{"warp", &MembraneElement::warp, Values::not_negative, Given::maybe,
                 "membrane_stiffnesses", &weft_scene::membrane_stiffnesses},
    ElementField{"weft", &MembraneElement::weft, Values::not_negative, Given::maybe,
                 "membrane_stiffnesses", &weft_scene::membrane_stiffnesses},
    ElementField{"shear", &MembraneElement::shear, Values::not_negative, Given::maybe,
                 "membrane_stiffnesses", &weft_scene::membrane_stiffnesses},
    ElementField{"kind", &MembraneElement::kind, Values::kind, Given::maybe, "membrane_kinds",
                 &weft_scene::membrane_kinds, Given::maybe},
    ElementField{"strength", &MembraneElement::strength, Values::positive_or_infinite, Given::maybe,
                 "membrane_strengths", &weft_scene::membrane_strengths, Given::maybe},
};

template <>
inline constexpr std::tuple kElementFields<BendingElement>{
    ElementField{"particles", &BendingElement::particles, Values::ruled, Given::always,
                 "bending_particles", &weft_scene::bending_particles},
    ElementField{"weights", &BendingElement::weights, Values::ruled, Given::always,
                 "bending_weights", &weft_scene::bending_weights},
    ElementField{"rest", &BendingElement::rest, Values::not_negative, Given::maybe, "bending_rests",
                 &weft_scene::bending_rests, Given::maybe},
    ElementField{"compliance", &BendingElement::compliance, Values::squared, Given::always,
                 "bending_compliances", &weft_scene::bending_compliances},
    ElementField{"fold", &BendingElement::fold, Values::ruled, Given::maybe, "bending_folds",
                 &weft_scene::bending_folds, Given::maybe},
    ElementField{"yield", &BendingElement::yield, Values::positive_or_infinite, Given::maybe,
                 "bending_yields", &weft_scene::bending_yields, Given::maybe},
    ElementField{"hardening", &BendingElement::hardening, Values::not_negative, Given::maybe,
                 "bending_hardenings", &weft_scene::bending_hardenings, Given::maybe},
    ElementField{"arm", &BendingElement::arm, Values::not_negative, Given::maybe, "bending_arms",
                 &weft_scene::bending_arms, Given::maybe},
};

template <>
inline constexpr std::tuple kElementFields<Anchor>{
    ElementField{"particle", &Anchor::particle, Values::particle, Given::always, "anchor_particles",
                 &weft_scene::anchor_particles},
    ElementField{"point", &Anchor::point, Values::finite, Given::always, "anchor_points",
                 &weft_scene::anchor_points},
    ElementField{"normal", &Anchor::normal, Values::ruled, Given::maybe, "anchor_normals",
                 &weft_scene::anchor_normals, Given::maybe},
    ElementField{"max_distance", &Anchor::max_distance, Values::not_negative_or_infinite,
                 Given::maybe, "anchor_max_distances", &weft_scene::anchor_max_distances,
                 Given::maybe},
    ElementField{"backstop_distance", &Anchor::backstop_distance, Values::not_negative,
                 Given::maybe, "backstop_distances", &weft_scene::backstop_distances, Given::maybe},
    ElementField{"backstop_radius", &Anchor::backstop_radius, Values::not_negative_or_infinite,
                 Given::maybe, "backstop_radii", &weft_scene::backstop_radii, Given::maybe},
    ElementField{"strength", &Anchor::strength, Values::positive_or_infinite, Given::maybe,
                 "anchor_strengths", &weft_scene::anchor_strengths, Given::maybe},
};

template <>
inline constexpr std::tuple kElementFields<Seam>{
    ElementField{"a", &Seam::a, Values::particle, Given::always, "seam_particles",
                 &weft_scene::seam_particles},
    ElementField{"b", &Seam::b, Values::particle, Given::always, "seam_particles",
                 &weft_scene::seam_particles},
    ElementField{"time", &Seam::time, Values::positive, Given::maybe, "seam_times",
                 &weft_scene::seam_times, Given::maybe},
    ElementField{"max_force", &Seam::max_force, Values::positive_or_infinite, Given::maybe,
                 "seam_max_forces", &weft_scene::seam_max_forces, Given::maybe},
    ElementField{"strength", &Seam::strength, Values::not_negative_or_infinite, Given::maybe,
                 "seam_strengths", &weft_scene::seam_strengths, Given::maybe},
};

template <>
inline constexpr std::tuple kElementFields<Tether>{
    ElementField{"particle", &Tether::particle, Values::particle, Given::always, "tether_particles",
                 &weft_scene::tether_particles},
    ElementField{"pin", &Tether::pin, Values::particle, Given::always, "tether_particles",
                 &weft_scene::tether_particles},
    ElementField{"length", &Tether::length, Values::squared, Given::always, "tether_lengths",
                 &weft_scene::tether_lengths},
};

template <>
inline constexpr std::tuple kElementFields<Slider>{
    ElementField{"particle", &Slider::particle, Values::particle, Given::always, "slider_particles",
                 &weft_scene::slider_particles},
    ElementField{"first", &Slider::first, Values::ruled, Given::always, "slider_rails",
                 &weft_scene::slider_rails},
    ElementField{"last", &Slider::last, Values::ruled, Given::always, "slider_rails",
                 &weft_scene::slider_rails},
    ElementField{"friction", &Slider::friction, Values::not_negative, Given::maybe,
                 "slider_frictions", &weft_scene::slider_frictions, Given::maybe},
};

/// The fields of a part, in the order in which its struct declares them; of the scene itself those
/// that are one value.
template <class Part>
inline constexpr std::tuple<> kPartFields{};

template <>
inline constexpr std::tuple kPartFields<Damping>{
    PartField{"stretch", &Damping::stretch, Values::not_negative, &weft_scene::damping_stretch,
              "s"},
    PartField{"bending", &Damping::bending, Values::not_negative, &weft_scene::damping_bending,
              "s"},
    PartField{"motion", &Damping::motion, Values::not_negative, &weft_scene::damping_motion, "1/s"},
};

template <>
inline constexpr std::tuple kPartFields<Air>{
    PartField{"triangles", &Air::triangles, Values::ruled, nullptr, "an array (n, 3) of particles"},
    PartField{"density", &Air::density, Values::not_negative, &weft_scene::air_density, "kg/m^3"},
    PartField{"drag", &Air::drag, Values::not_negative, &weft_scene::air_drag,
              "of the area that a triangle shows"},
    PartField{"lift", &Air::lift, Values::not_negative, &weft_scene::air_lift, "across the wind"},
    PartField{"wind", &Air::wind, Values::finite, &weft_scene::wind, "m/s"},
    PartField{"ram", &Air::ram, Values::not_negative, &weft_scene::air_ram,
              "of the flow that a piece of the cloth catches"},
};

template <>
inline constexpr std::tuple kPartFields<Pressure>{
    PartField{"pressure", &Pressure::pressure, Values::finite, &weft_pressure::pressure,
              "Pa, more than the air around has", Given::always},
    PartField{"triangles", &Pressure::triangles, Values::ruled, nullptr,
              "by their numbers; empty: all"},
    PartField{"gas", &Pressure::gas, Values::ruled, &weft_pressure::gas,
              "whether it falls as the volume grows"},
    PartField{"volume", &Pressure::volume, Values::not_negative, &weft_pressure::volume,
              "m^3, where a gas has the pressure; 0: that of now"},
    PartField{"ambient", &Pressure::ambient, Values::positive, &weft_pressure::ambient,
              "Pa, of the air around a gas"},
};

template <>
inline constexpr std::tuple kPartFields<SelfContact>{
    PartField{"on", &SelfContact::on, Values::ruled, &weft_scene::self_contact,
              "whether layers of the cloth keep off each other"},
    PartField{"thickness", &SelfContact::thickness, Values::not_negative,
              &weft_scene::self_contact_thickness, "m, from the middle of one to that of the next"},
    PartField{"friction", &SelfContact::friction, Values::not_negative,
              &weft_scene::self_contact_friction, "Coulomb's, between layers"},
    PartField{"untangle", &SelfContact::untangle, Values::ruled, &weft_scene::self_contact_untangle,
              "whether triangles that cross are pulled apart"},
};

template <>
inline constexpr std::tuple kPartFields<SceneDescription>{
    PartField{"friction", &SceneDescription::friction, Values::not_negative, &weft_scene::friction,
              "Coulomb's, of the cloth beside bodies"},
    PartField{"gravity", &SceneDescription::gravity, Values::finite, &weft_scene::gravity, "m/s^2",
              Given::always},
    PartField{"tether_slack", &SceneDescription::tether_slack, Values::not_negative_or_infinite,
              &weft_scene::tether_slack,
              "of a tether to the nearest pin; infinite: there are none"},
};

template <>
inline constexpr std::tuple kPartFields<ModelInfo>{
    PartField{"particles", &ModelInfo::particles, Values::ruled, &weft_model_info::particles,
              "fixed ones too"},
    PartField{"constraints", &ModelInfo::constraints, Values::ruled, &weft_model_info::constraints,
              "active ones, without contacts"},
    PartField{"inert_constraints", &ModelInfo::inert_constraints, Values::ruled,
              &weft_model_info::inert_constraints, "between fixed particles"},
    PartField{"ropes", &ModelInfo::ropes, Values::ruled, &weft_model_info::ropes,
              "constraints that only pull"},
    PartField{"compliant", &ModelInfo::compliant, Values::ruled, &weft_model_info::compliant,
              "constraints that are springs"},
    PartField{"membrane_elements", &ModelInfo::membrane_elements, Values::ruled,
              &weft_model_info::membrane_elements, "active ones"},
    PartField{"bending_elements", &ModelInfo::bending_elements, Values::ruled,
              &weft_model_info::bending_elements, "active ones"},
    PartField{"anchors", &ModelInfo::anchors, Values::ruled, &weft_model_info::anchors,
              "points that hold particles"},
    PartField{"seams", &ModelInfo::seams, Values::ruled, &weft_model_info::seams,
              "pairs that come together"},
    PartField{"surface_triangles", &ModelInfo::surface_triangles, Values::ruled,
              &weft_model_info::surface_triangles, "that meshes touch"},
    PartField{"air_triangles", &ModelInfo::air_triangles, Values::ruled,
              &weft_model_info::air_triangles, "with drag and lift"},
    PartField{"spheres", &ModelInfo::spheres, Values::ruled, &weft_model_info::spheres,
              "particles that others collide with"},
    PartField{"colours", &ModelInfo::colours, Values::ruled, &weft_model_info::colours,
              "groups of constraints that share no particle"},
    PartField{"tiles", &ModelInfo::tiles, Values::ruled, &weft_model_info::tiles,
              "groups that threads may work on in parallel"},
    PartField{"run_share", &ModelInfo::run_share, Values::ruled, &weft_model_info::run_share,
              "of the constraints in contiguous runs"},
    PartField{"bytes", &ModelInfo::bytes, Values::ruled, &weft_model_info::bytes,
              "held by the model"},
    PartField{"tethers", &ModelInfo::tethers, Values::ruled, &weft_model_info::tethers, "that act"},
};

inline constexpr std::tuple kElementKinds{
    ElementKind{"constraints", "Constraint", &SceneDescription::constraints,
                &weft_scene::constraint_count},
    ElementKind{"membrane", "MembraneElement", &SceneDescription::membrane,
                &weft_scene::membrane_count},
    ElementKind{"bending", "BendingElement", &SceneDescription::bending,
                &weft_scene::bending_count},
    ElementKind{"anchors", "Anchor", &SceneDescription::anchors, &weft_scene::anchor_count},
    ElementKind{"seams", "Seam", &SceneDescription::seams, &weft_scene::seam_count},
    ElementKind{"tethers", "Tether", &SceneDescription::tethers, &weft_scene::tether_count},
    ElementKind{"sliders", "Slider", &SceneDescription::sliders, &weft_scene::slider_count},
};

namespace detail {

template <class... Items, class Visit>
constexpr void for_each_of(const std::tuple<Items...>& items, Visit& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (visit(std::get<i>(items)), ...); }
  (std::index_sequence_for<Items...>());
}

template <class... Element>
constexpr bool have_all_fields(const std::tuple<ElementKind<Element>...>&) {
  return (has_fields<Element, std::tuple_size_v<decltype(kElementFields<Element>)>>() && ...);
}

template <class Part>
constexpr bool has_all_fields() {
  return has_fields<Part, std::tuple_size_v<decltype(kPartFields<Part>)>>();
}

}  // namespace detail

static_assert(detail::has_all_fields<Damping>() && detail::has_all_fields<Air>() &&
                  detail::has_all_fields<Pressure>() && detail::has_all_fields<SelfContact>() &&
                  detail::has_all_fields<ModelInfo>(),
              "a field of a part is missing in its kPartFields");
static_assert(detail::have_all_fields(kElementKinds),
              "a field of an element is missing in its kElementFields");

/// Calls visit(kind) with each ElementKind.
template <class Visit>
constexpr void for_each_element_kind(Visit&& visit) {
  detail::for_each_of(kElementKinds, visit);
}

/// Calls visit(field) with each ElementField.
template <class Element, class Visit>
constexpr void for_each_element_field(Visit&& visit) {
  detail::for_each_of(kElementFields<Element>, visit);
}

/// Calls visit(field) with each PartField.
template <class Part, class Visit>
constexpr void for_each_part_field(Visit&& visit) {
  detail::for_each_of(kPartFields<Part>, visit);
}

}  // namespace weft
