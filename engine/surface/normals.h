/// Smooth normals: of each point the sum of the area vectors of the faces around it, made a unit.
#pragma once

#include <weft/scene.h>

#include <span>

#include "engine/surface/drawn_mesh.h"

namespace weft::surface {

/// One vector, as four floats are loaded at once.
struct alignas(16) Quad {
  float x = 0, y = 0, z = 0, spare = 0;
};
inline Quad operator+(Quad a, Quad b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.spare + b.spare};
}
inline Quad operator-(Quad a, Quad b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.spare - b.spare};
}
inline Quad operator*(float s, Quad a) { return {s * a.x, s * a.y, s * a.z, s * a.spare}; }
inline Quad cross(Quad a, Quad b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x, 0};
}
/// Along v; (0, 0, 1) where v is 0.
Quad unit(Quad v);

/// Positions relative to the first, times the scale: about 1 / the extent of them all, so that
/// floats can square areas.
void to_quads(std::span<const Vec3> positions, double scale, std::span<Quad> quads);
/// 1 / the longest side of the box around them; 1 where that is a point.
double scale_of(std::span<const Vec3> positions);

/// Twice the areas around each point, which are no units yet. points: as to_quads gives them.
void find_areas(const PointFaces& faces, std::span<const Quad> points, std::span<Quad> normals);
/// The same as units.
void find_normals(const PointFaces& faces, std::span<const Quad> points, std::span<Quad> normals);

}  // namespace weft::surface
