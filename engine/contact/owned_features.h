/// Pairs of features that two triangles own, where their tubes meet.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/contact/features.h"
#include "engine/contact/points.h"
#include "engine/contact/stars.h"
#include "engine/contact/surface.h"

namespace weft {

/// Adds the pairs of features that a triangle of one surface and those of another one own. By x, y
/// and z alone big boxes of slanted triangles and edges meet those of dozens that lie beside them:
/// tubes are to meet along the normal of the first triangle, and in its plane across its edges,
/// too.
class OwnedFeatures {
 public:
  OwnedFeatures(const simd::Table& table, ContactPoints& points, SurfacePair surfaces,
                Candidates& candidates)
      : table_(table),
        points_(points),
        surfaces_(surfaces),
        a_(points.surfaces()[surfaces.a]),
        b_(points.surfaces()[surfaces.b]),
        may_cross_(points.surfaces()[surfaces.b].may_cross),
        candidates_(candidates) {}

  /// The triangle of the first surface that others are beside from now on.
  void begin(std::uint32_t a) {
    const TriangleSurface::Triangle points = a_.points_of(a);
    for (const std::uint32_t point : points) points_.tube(point);
    const simd::PointTube* tubes = points_.lane_tubes();
    begin(a, {tubes + points[0], tubes + points[1], tubes + points[2]});
  }
  /// tubes: of its corners.
  void begin(std::uint32_t a, const std::array<const simd::PointTube*, 3>& tubes) {
    finish();
    triangle_a_ = a;
    corners_a_ = a_.points_of(a);
    set_axes();
    table_.reaches_of_triangle(axes_, tubes.data(), reaches_);
  }
  std::uint32_t triangle() const { return triangle_a_; }
  /// It is beside that of the second surface.
  void add(std::uint32_t b) {
    if (waiting_ == kernels::kLanes) finish();
    const TriangleSurface::Triangle corners = b_.points_of(b);
    for (std::size_t k = 0; k < 3; ++k) {
      points_.tube(corners[k]);
      corners_b_[waiting_][k] = corners[k];
    }
    wanted_[waiting_] = owned_with(b);
    triangles_b_[waiting_++] = b;
  }
  /// Adds the features of all that were told.
  void finish() {
    if (waiting_ == 0) return;
    table_.meet_triangles({.axes = &axes_,
                           .reaches = &reaches_,
                           .tubes = points_.lane_tubes(),
                           .corners = corners_b_.data(),
                           .wanted = wanted_.data(),
                           .met = met_.data()},
                          waiting_);
    for (std::size_t i = 0; i < waiting_; ++i) {
      if (met_[i] != 0) add_features(i, met_[i]);
    }
    waiting_ = 0;
  }

 private:
  /// Bits of simd::TriangleMeeting: the features that both triangles own.
  std::uint16_t owned_with(std::uint32_t b) const {
    const std::uint32_t of_a = a_.triangles->owns[triangle_a_], of_b = b_.triangles->owns[b];
    if (a_.triangles->is_point(triangle_a_)) return static_cast<std::uint16_t>((of_a & 7) << 1);
    std::uint32_t owned = 0;
    if (corners_touch(*a_.triangles, triangle_a_, *b_.triangles, b)) owned |= (of_a & 7) << 1;
    if (corners_touch(*b_.triangles, b, *a_.triangles, triangle_a_)) owned |= (of_b & 7) << 4;
    for (std::uint32_t j = 0; j < 3; ++j) {
      if (b_.triangles->owns_edge(b, j)) owned |= (of_a >> 3 & 7) << (7 + 3 * j);
    }
    return static_cast<std::uint16_t>(owned);
  }
  /// Those of one triangle beside another one. The edges at a corner of a face touch a thread that
  /// lies over it: the corner alone would let it off to any side.
  bool corners_touch(const TriangleSurface& a, std::uint32_t of, const TriangleSurface& b,
                     std::uint32_t other) const {
    return surfaces_.a != surfaces_.b || !a.is_face(of) || !b.is_thread(other);
  }
  void add_features(std::size_t i, std::uint32_t met) {
    may_cross_[triangle_a_] = 1;
    for (std::uint32_t left = met & ~1u; left != 0; left &= left - 1)
      add_feature(triangles_b_[i], corners_b_[i], static_cast<std::size_t>(std::countr_zero(left)));
  }
  /// Adds a feature of the triangle b, which has these corners.
  void add_feature(std::uint32_t b, const std::uint32_t (&corners)[3], std::size_t bit) {
    if (bit < 4) {
      const std::uint32_t point = corners_a_[bit - 1];
      add_pair({point - a_.first_point, b, surfaces_.a, surfaces_.b, PairKind::point_triangle},
               {point, corners[0], corners[1], corners[2]}, b);
    } else if (bit < 7) {
      const std::uint32_t point = corners[bit - 4];
      add_pair(
          {point - b_.first_point, triangle_a_, surfaces_.b, surfaces_.a, PairKind::point_triangle},
          {point, corners_a_[0], corners_a_[1], corners_a_[2]}, b);
    } else {
      const std::size_t j = (bit - 7) / 3, k = (bit - 7) % 3;
      add_pair({a_.triangles->edges_of[triangle_a_][k], b_.triangles->edges_of[b][j], surfaces_.a,
                surfaces_.b, PairKind::edges},
               {corners_a_[k], corners_a_[(k + 1) % 3], corners[j], corners[(j + 1) % 3]}, b);
    }
  }
  /// Axes at the start of the interval, of any length. A thread has any two directions across it.
  void set_axes() {
    const kernels::Vector x[] = {points_.start(corners_a_[0]), points_.start(corners_a_[1]),
                                 points_.start(corners_a_[2])};
    const kernels::Vector n = a_.triangles->is_thread(triangle_a_)
                                  ? across(x[1] - x[0])
                                  : cross(x[1] - x[0], x[2] - x[0]);
    set_axis(0, n);
    for (std::size_t k = 0; k < 3; ++k) set_axis(1 + k, cross(n, x[(k + 1) % 3] - x[k]));
  }
  static kernels::Vector across(kernels::Vector v) {
    const bool is_along_x = std::abs(v.x) > std::abs(v.y) && std::abs(v.x) > std::abs(v.z);
    return cross(v, is_along_x ? kernels::Vector{0, 1, 0} : kernels::Vector{1, 0, 0});
  }
  void set_axis(std::size_t i, kernels::Vector v) {
    const double l = length(v), scale = l > 0 ? 1 / l : 0;
    for (const std::size_t lane : {4 + i, 12 + i}) {
      axes_.x[lane] = static_cast<float>(scale * v.x);
      axes_.y[lane] = static_cast<float>(scale * v.y);
      axes_.z[lane] = static_cast<float>(scale * v.z);
    }
  }
  /// Within the cloth: Stars adds it where it may touch, or it never does.
  bool is_left_out(const Pair& pair, const std::array<std::uint32_t, 4>& points) const {
    return are_in_one_star(points_.cloth(), pair) || points_.sewn().join(pair.kind, points);
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points, std::uint32_t b) {
    if (pair.is_within_cloth() && is_left_out(pair, points)) return;
    candidates_[list_of(pair)].add(pair, points);
    if (pair.is_within_cloth()) return;
    if (std::exchange(active_, b) != b) points_.activate(surfaces_.b, b);
  }

  const simd::Table& table_;
  ContactPoints& points_;
  const SurfacePair surfaces_;
  const ContactSurface &a_, &b_;
  std::vector<std::uint8_t>& may_cross_;
  Candidates& candidates_;
  std::uint32_t triangle_a_ = kNoIndex, active_ = kNoIndex;
  TriangleSurface::Triangle corners_a_{};
  simd::ReachAxes axes_;
  simd::TriangleReaches reaches_{};
  std::size_t waiting_ = 0;
  std::array<std::uint32_t, kernels::kLanes> triangles_b_{};
  std::array<std::uint32_t[3], kernels::kLanes> corners_b_{};
  std::array<std::uint16_t, kernels::kLanes> wanted_{}, met_{};
};

}  // namespace weft
