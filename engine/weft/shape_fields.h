/// The shapes of bodies and their fields, as one list each, for code that treats all of them alike:
/// that checks, saves, reads or writes shapes. weft.h does not include it. A new shape needs a
/// struct in body.h, its list of fields here, and its form (engine/README.md).
///
///   weft::for_each_part_field<weft::Ball>(
///       [&](const auto& field) { print(field.name, ball.*field.member); });
#pragma once

#include <weft/body.h>
#include <weft/scene_fields.h>

#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>

namespace weft {

struct ShapeKind {
  const char* name;  ///< in a scene file
  const char* type;
  const char* text;   ///< in a message
  const char* about;  ///< a sentence
  bool has_mass;      ///< mass_of knows it
};

template <class Shape>
inline constexpr ShapeKind kShapeKind{};

template <>
inline constexpr ShapeKind kShapeKind<Plane>{"plane", "Plane", "a plane",
                                             "The half space where normal . x < offset.", false};
template <>
inline constexpr std::tuple kPartFields<Plane>{
    PartField{"normal", &Plane::normal, Values::finite, nullptr, "of any length but 0"},
    PartField{"offset", &Plane::offset, Values::finite, nullptr, "in units of the normal"},
};

template <>
inline constexpr ShapeKind kShapeKind<Ball>{"sphere", "Ball", "a ball", "A ball.", true};
template <>
inline constexpr std::tuple kPartFields<Ball>{
    PartField{"centre", &Ball::centre, Values::finite, nullptr, "m"},
    PartField{"radius", &Ball::radius, Values::positive, nullptr, "m", Given::always},
};

template <>
inline constexpr ShapeKind kShapeKind<Capsule>{"capsule", "Capsule", "a capsule",
                                               "All balls whose centres lie on a segment.", true};
template <>
inline constexpr std::tuple kPartFields<Capsule>{
    PartField{"a", &Capsule::a, Values::finite, nullptr, "m", Given::always},
    PartField{"b", &Capsule::b, Values::finite, nullptr, "m", Given::always},
    PartField{"radius_a", &Capsule::radius_a, Values::positive, nullptr, "m", Given::always},
    PartField{"radius_b", &Capsule::radius_b, Values::positive, nullptr, "m", Given::always},
};

template <>
inline constexpr ShapeKind kShapeKind<Hull>{"hull", "Hull", "a hull", "The convex hull of points.",
                                            true};
template <>
inline constexpr std::tuple kPartFields<Hull>{
    PartField{"points", &Hull::points, Values::finite, nullptr, "m, an array (n, 3)",
              Given::always},
};

template <>
inline constexpr ShapeKind kShapeKind<TriangleMesh>{"mesh", "TriangleMesh", "a triangle mesh",
                                                    "A surface of triangles, rigid or deforming.",
                                                    false};
template <>
inline constexpr std::tuple kPartFields<TriangleMesh>{
    PartField{"vertices", &TriangleMesh::vertices, Values::finite, nullptr, "m, an array (n, 3)",
              Given::always},
    PartField{"triangles", &TriangleMesh::triangles, Values::ruled, nullptr,
              "an array (n, 3) of vertices", Given::always},
    PartField{"two_sided", &TriangleMesh::two_sided, Values::ruled, nullptr,
              "keeps cloth on the side where it is"},
};

template <>
inline constexpr ShapeKind kShapeKind<HeightField>{
    "height_field", "HeightField", "a height field",
    "Terrain: the solid under a surface over a rectangle.", false};
template <>
inline constexpr std::tuple kPartFields<HeightField>{
    PartField{"columns", &HeightField::columns, Values::ruled, nullptr, "points along x",
              Given::always},
    PartField{"rows", &HeightField::rows, Values::ruled, nullptr, "points along z", Given::always},
    PartField{"spacing_x", &HeightField::spacing_x, Values::positive, nullptr, "m", Given::always},
    PartField{"spacing_z", &HeightField::spacing_z, Values::positive, nullptr, "m", Given::always},
    PartField{"heights", &HeightField::heights, Values::finite, nullptr,
              "m, an array (rows * columns), row by row", Given::always},
};

template <>
inline constexpr ShapeKind kShapeKind<Torus>{"torus", "Torus", "a torus", "A ring.", true};
template <>
inline constexpr std::tuple kPartFields<Torus>{
    PartField{"centre", &Torus::centre, Values::finite, nullptr, "m"},
    PartField{"axis", &Torus::axis, Values::finite, nullptr, "of any length but 0"},
    PartField{"major", &Torus::major, Values::positive, nullptr, "m, of its circle", Given::always},
    PartField{"minor", &Torus::minor, Values::positive, nullptr, "m, around it", Given::always},
};

namespace detail {

template <class... Shape>
constexpr bool have_all_fields(const std::variant<Shape...>*) {
  return (has_all_fields<Shape>() && ...);
}

template <class... Shape, class Visit>
constexpr void for_each_shape(const std::variant<Shape...>*, Visit& visit) {
  (visit.template operator()<Shape>(), ...);
}

inline constexpr const ShapeDescription* kNoShape = nullptr;

}  // namespace detail

static_assert(detail::have_all_fields(detail::kNoShape),
              "a field of a shape is missing in its kPartFields");

/// Calls visit.operator()<Shape>() for each of them.
template <class Visit>
constexpr void for_each_shape(Visit&& visit) {
  detail::for_each_shape(detail::kNoShape, visit);
}

inline const ShapeKind& kind_of(const ShapeDescription& shape) {
  return std::visit([]<class Shape>(const Shape&) -> const ShapeKind& { return kShapeKind<Shape>; },
                    shape);
}

}  // namespace weft
