/// The particles inside a one-sided body, and the triangles of the cloth that cross a body. Causes
/// are a body that was placed there, written positions, or features that could not be kept apart.
///
/// A particle inside a body is remembered until it is out, and is pushed out along the shortest
/// way. Edges and faces of triangles that cross do not collide until they are apart. The exception
/// is a triangle through which a corner or an edge of a one-sided body leads: it is pushed off
/// along the body's normal. Particles of triangles that cross collide as all others do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/misplaced.h"
#include "engine/contact/near_pairs.h"
#include "engine/contact/points.h"
#include "engine/contact/self_tangles.h"

namespace weft {

class Tangles {
 public:
  explicit Tangles(const simd::Table& table) : table_(table), within_(table) {}

  /// Begins a frame with the tangles that the frame before left.
  void begin(const TriangleSurface& cloth, const Misplaced& misplaced);
  /// An interval begins: pairs that cross now are left alone until it is over.
  void begin_interval();
  /// Finds anew what is inside and what crosses where an interval begins: bodies, and the cloth
  /// itself.
  void find(ContactPoints& points);
  void find_within(const ContactPoints& points);
  /// Adds to near pairs those by which particles come out that are inside, and triangles off what
  /// leads through them. Forgets particles that are out.
  void come_out(ContactPoints& points, Near& near);
  /// The pair could not be kept apart.
  void take_in(const ContactPoints& points, const Pair& pair);
  /// Cloth between two bodies that overlap is inside both: it is no failure of the pair.
  void let_in(const ContactPoints& points, const Pair& pair);
  /// Finds what crosses where an interval ends: bodies, and the cloth itself.
  void find_crossing_at_end(ContactPoints& points);
  /// has_failed: something had to be stopped in the interval.
  void find_crossing_within_at_end(const ContactPoints& points, bool has_failed);

  bool any() const {
    return !triangles_.empty() || !crossing_.empty() || !misplaced_.inside.empty();
  }
  bool is_inside(std::uint32_t slot) const { return misplaced_.is_inside(slot); }
  bool is_inside(const std::array<std::uint32_t, 4>& points) const {
    return !misplaced_.inside.empty() && any_is_inside(points);
  }
  /// Whether the pair is left alone.
  bool leaves_out(const Pair& pair) const {
    if (pair.is_within_cloth()) return within_.leaves_out(pair);
    if (triangles_.empty()) return false;
    if (pair.kind == PairKind::edges) return has_edge_[pair.first];
    return pair.b == kClothSurface && has_triangle_[pair.second];
  }
  /// Whether a contact within the cloth has no side there.
  bool cross_beside(const Pair& pair, const std::array<std::uint32_t, 4>& points) const {
    return within_.cross_beside(pair, points);
  }
  /// Triangles that cross, and particles inside.
  int count() const {
    return static_cast<int>(crossing_.size()) + static_cast<int>(misplaced_.inside.size());
  }
  /// Pairs of triangles of the cloth that cross each other.
  int count_within() const { return static_cast<int>(within_.crossing().size()); }
  const std::vector<std::uint64_t>& crossing_within() const { return within_.crossing(); }
  const Misplaced& misplaced() const { return misplaced_; }
  std::size_t bytes() const;

 private:
  template <class At>
  void find_crossing(ContactPoints& points, At&& at);
  template <class At>
  bool crosses(ContactPoints& points, std::uint32_t triangle, At&& at) const;
  bool any_is_inside(const std::array<std::uint32_t, 4>& points) const;
  void come_off(ContactPoints& points, std::uint32_t triangle, Near& near) const;
  static void come_off_corner(ContactPoints& points, SurfacePair pair, std::uint32_t triangle,
                              std::array<std::uint32_t, 2> edge, Near& near);
  void come_off_edges(ContactPoints& points, SurfacePair pair, std::uint32_t edge,
                      std::uint32_t triangle, Near& near) const;
  static void add_under(const ContactPoints& points, const Pair& pair,
                        const std::array<std::uint32_t, 4>& four, kernels::Vector normal,
                        Near& near);
  void leave_alone(std::uint32_t triangle);
  void leave_crossing_alone();
  void gather_slots();

  const simd::Table& table_;
  const TriangleSurface* cloth_ = nullptr;
  Misplaced misplaced_;
  SelfTangles within_;
  std::vector<std::uint32_t> crossing_;        // triangles, as last found
  std::vector<std::uint32_t> triangles_;       // that are left alone in the interval
  std::vector<bool> has_triangle_, has_edge_;  // empty until the first one crosses
};

}  // namespace weft
