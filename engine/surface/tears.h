/// Surfaces of cloth that has torn: vertices along a tear become several.
#pragma once

#include <weft/scene.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/surface/drawn_mesh.h"
#include "engine/surface/following.h"

namespace weft::surface {

/// Points of the corners of each triangle of a mesh that was made with parts. before and now: the
/// parts as described and as torn, with particles as corners.
std::vector<Triangle> corners_now(const DrawnMesh& drawn, std::span<const Triangle> before,
                                  std::span<const Triangle> now);

struct TornMesh {
  DrawnMesh drawn;                        ///< its new vertices come last
  std::vector<std::uint32_t> split_from;  ///< per new vertex: the one that it was split from
};
/// corners: per triangle, the points that its corners are at now.
TornMesh torn_mesh(const DrawnMesh& drawn, std::span<const Triangle> corners);

/// A cloth and points that follow its triangles, where they lie at the beginning.
struct MappedStart {
  std::vector<Triangle> triangles;  ///< of the cloth, with particles as corners
  std::vector<Vec3> particles;
  std::vector<Quad> normals;  ///< of the particles
  std::vector<Vec3> points;
  std::vector<std::uint32_t> triangle_of;  ///< per point: that which it follows

  std::size_t bytes() const;
};

struct TornPoints {
  std::vector<Triangle> corners;  ///< per triangle of the mesh that follows: its points
  std::vector<Following> points;  ///< as they were, and new ones
};
/// A triangle of the mesh that follows goes with the cloth at its middle. Where a tear leads
/// between that and a corner, the corner becomes another point, which follows the cloth on the
/// side of the middle. triangles: those of the start, as torn.
TornPoints torn_points(const MappedStart& start, std::span<const Triangle> triangles,
                       const DrawnMesh& drawn, std::span<const Following> points);

}  // namespace weft::surface
