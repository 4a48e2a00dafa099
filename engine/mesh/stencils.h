/// Single bending elements: the curvature that each reads, and its weight.
#pragma once

#include <weft/weft.h>

#include <array>

#include "engine/geometry.h"

namespace weft::mesh {

/// A bending element that has its weights but not yet its compliance. On a surface z = x^T K x / 2
/// over the flattened faces, of curvature K, it reads d = sum of M_ij K_ij.
struct Stencil {
  std::array<std::uint32_t, 4> particles{};  ///< the last may be kNoIndex
  std::array<double, 4> weights{};           ///< 1/m: d is an angle
  double rest = 0;                           ///< |d| of the shape at rest, of rays
  double fold = 0;                           ///< d along the normal at rest, of hinges
  Tensor reading;                            ///< M
};

/// A point of an element: its particle, and its place in the face that it belongs to.
struct Point {
  std::uint32_t particle = 0;
  Vec3 place;
};

/// The bend between two triangles with a common edge from a to b: the sum of the slopes at which
/// their far corners leave it, in the plane that both are unfolded into. The second triangle has
/// the edge at places of its own. Across a seam these may be anywhere, and the plane is that of the
/// first.
Stencil hinge(Point a, Point b, Point far_a, Point far_b, Vec3 a_of_other, Vec3 b_of_other,
              bool is_seam);

/// Where both far corners and one end of the edge, `kept`, are on one line, the other end has no
/// weight: then it goes, and three points remain, with the kept one between the others.
Stencil without_end(const Stencil& hinge, std::uint32_t kept);

/// Sum of the weighted places.
Vec3 weighted_sum(const std::array<double, 4>& weights, const std::array<Vec3, 4>& places);

/// d along the normal of a hinge whose points have these places at rest; 0 where rounding explains
/// it.
double fold_of(const Stencil& hinge, const std::array<Vec3, 4>& places, double extent);

/// |sum|, of the weighted places at rest; 0 where rounding of places in single precision explains
/// it, with the extent of the mesh in m.
double rest_of(const Stencil& stencil, Vec3 sum, double extent);

/// The weight of an element that reads one curvature of a grid and stores that of an area alone.
double weight_in_grid(const Stencil& stencil, double area);
/// The weight of one that shares its area with others of other directions: the mean over cylinders
/// of all directions is that of the area. (The mean of (u^T M u)^2 over all unit vectors u of the
/// plane is (2 |M|^2 + tr(M)^2) / 8.)
double weight_among_others(const Stencil& stencil, double area);

}  // namespace weft::mesh
