/// How many triangles of two surfaces, or of one, cross: by exact geometry, and by
/// nothing that the engine finds contacts with.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tools/scenes/scene_body.h"

namespace weft::tools {

/// Triangles by their corners' places.
struct TriangleSet {
  std::vector<Vec3> places;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// All bodies that are meshes, as one, where they are at a time.
TriangleSet meshes_at(std::span<const SceneBody> bodies, double time);

/// Pairs of a triangle of `a` and one of `b` whose boxes, grown by `reach` (m), meet.
std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(const TriangleSet& a,
                                                                const TriangleSet& b, double reach);

/// Pairs of triangles of which an edge of one leads through the other. What only touches does not
/// cross.
std::size_t count_crossings(const TriangleSet& a, const TriangleSet& b);
/// Of a surface with itself, each pair once.
std::size_t count_crossings(const TriangleSet& surface);
/// Two triangles of one surface.
bool do_cross(const TriangleSet& surface, std::uint32_t one, std::uint32_t other);

/// The first triangle of a cloth that crosses a body.
struct NamedCrossing {
  std::size_t count = 0;       ///< pairs of triangles, of all bodies
  std::uint32_t triangle = 0;  ///< of the cloth
  std::size_t body = 0;        ///< by its place among all bodies
  Vec3 place{};                ///< the middle of the triangle
};
NamedCrossing name_crossing(const TriangleSet& cloth, std::span<const SceneBody> bodies,
                            double time);

}  // namespace weft::tools
