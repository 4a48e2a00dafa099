/// The places of the points of surfaces in an interval of some substeps, and the boxes in which
/// they are expected to stay.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/particles.h"
#include "engine/contact/speeds.h"
#include "engine/contact/surfaces.h"
#include "engine/sparse_array.h"
#include "kernels/vectors.h"

namespace weft {

class ContactPoints : public ContactSurfaces {
 public:
  using ContactSurfaces::ContactSurfaces;

  /// Begins a frame.
  void begin(const BodyClock& clock);
  /// Finds the speeds of a step, whose first substep is predicted. It is not needed
  /// while bodies stand.
  void look_ahead(const ContactParticles& cloth, const BodyClock& clock);
  const ContactSpeeds& speeds() const { return speeds_; }
  /// Begins an interval, whose first substep is predicted. It places the active vertices of bodies:
  /// those of triangles that are looked at, and their neighbours.
  void begin_interval(const ContactParticles& cloth, const BodyClock& clock, int substeps);
  /// The triangle of a body is looked at: its vertices are active until tubes are laid anew.
  void activate(std::uint16_t surface, std::uint32_t triangle);
  /// m, that a point may come off the way that it is expected to take: a share of the ways that its
  /// neighbours take, and that bodies do, for these may take it along.
  double reach(std::uint32_t point) const { return is_of_cloth(point) ? reach_[point] : 0; }
  double largest_reach() const { return largest_reach_; }
  kernels::Vector way(std::uint32_t point) const { return end_[point] - start_[point]; }
  /// m, that a point of the cloth and one of a body may be expected to move beside each other, at
  /// most: in the interval, and since the last one began.
  float largest_way() const {
    const double of_both = touches_itself() ? 2 * largest_way_ : 0;
    return static_cast<float>(std::max(largest_way_ + way_of_bodies_, of_both));
  }
  float travelled() const { return static_cast<float>(travelled_); }
  /// m, that two points of a pair may come off their ways, together.
  double largest_reach_of_pair() const { return (touches_itself() ? 2 : 1) * largest_reach_; }
  /// m, that they have moved in the interval, once moves are measured.
  float largest_move() const;
  kernels::Vector origin() const { return origin_; }
  /// Where the point was when the interval began.
  kernels::Vector start(std::uint32_t point) const { return start_[point]; }
  /// A box around all places that it is expected to come to in the interval.
  const Box& box(std::uint32_t point) const { return box_[point]; }
  /// A tube around those of all intervals until the step ends, as far as known when candidates were
  /// looked for. Those of vertices are made when they are first asked for.
  const Tube& tube(std::uint32_t point) {
    if (!is_of_cloth(point) && laid_[point - slots()] != layings_) lay_vertex(point);
    return tube_[point];
  }
  /// The same as kernels read it: of all points, those of vertices once they are made.
  const simd::PointTube* lane_tubes() const { return lane_tubes_.data(); }
  /// All of a triangle, in the coordinates of a body's tree.
  Box in_tree(const ContactSurface& body, const TriangleSurface::Triangle& points) {
    Box box = body.as_in_tree(tube(points[0]));
    box.add(body.as_in_tree(tube(points[1])));
    box.add(body.as_in_tree(tube(points[2])));
    return box;
  }
  bool has_tubes() const { return has_tubes_; }
  void lay_tubes();
  /// Renews those of cloth that hold no longer; moved(slot), of each.
  template <class Moved>
  void renew_tubes(Moved&& moved);
  /// It holds no longer.
  void forget_tube(std::uint32_t slot) { set_tube(slot, {Box::none(), Box::none()}); }
  /// Widens the tube of a point that came to an unexpected place to all of its way.
  void widen_tube_to_way(std::uint32_t slot) { set_tube(slot, {box_[slot], box_[slot]}); }
  /// In quads, from the origin. The fourth of a way is the point's reach.
  const float* starts() const { return start_quads_.data(); }
  const float* ways() const { return way_quads_.data(); }

  /// Where any vertex is when the present substep ends.
  kernels::Vector vertex_now(const BodyClock& clock, std::uint32_t point) const {
    const ContactSurface& surface = surface_of(point);
    if (surface.stands) return start_[point];
    return clock.vertex(surface.body, point - surface.first_point, clock.motions()[surface.body].to,
                        clock.share_after(0));
  }

  /// From the start of the interval to now, in quads. Vertices have moved as they were to.
  void measure_moves(const ContactParticles& cloth);
  const float* moves() const { return way_quads_.data(); }
  /// Where a point is now, once moves are measured.
  kernels::Vector end(std::uint32_t point) const { return end_[point]; }
  void set_end(std::uint32_t point, kernels::Vector x);
  FourPoints starts_of(const std::array<std::uint32_t, 4>& points) const {
    return {start(points[0]), start(points[1]), start(points[2]), start(points[3])};
  }
  FourPoints ends_of(const std::array<std::uint32_t, 4>& points) const {
    return {end(points[0]), end(points[1]), end(points[2]), end(points[3])};
  }
  /// Whether the point came to a place that was expected.
  bool holds_end(std::uint32_t point) const;
  /// Whether all particles are now where they were expected in the interval.
  bool hold(const ContactParticles& cloth) const;
  /// Makes the box of a point hold its way.
  void take_way_in(std::uint32_t point);
  /// m, of quads: of the cloth, and of the vertices that are active, too. Those of a large triangle
  /// are far away.
  float rounding_of_cloth() const { return rounding_; }
  float rounding() const { return std::max(rounding_, rounding_of_vertices_); }
  std::size_t bytes() const;

 private:
  static void write(SparseArray<float>& quads, std::size_t point, kernels::Vector v) {
    quads[4 * point] = static_cast<float>(v.x);
    quads[4 * point + 1] = static_cast<float>(v.y);
    quads[4 * point + 2] = static_cast<float>(v.z);
  }
  /// m, that a box of the cloth holds beyond all places for other cloth.
  double beside_itself() const {
    return touches_itself() ? 0.5 * surfaces()[kClothSurface].thickness : 0;
  }
  void make_room();
  bool holds(std::uint32_t point, kernels::Vector place) const;
  void see_from(ContactSurface& surface, const PoseTravel& travel) const;
  void activate_vertex(std::uint32_t point);
  void forget_active();
  void place_vertex(std::uint32_t point);
  void write_start_and_way(std::size_t point);
  Tube tube_around(std::uint32_t slot) const;
  void set_tube(std::uint32_t point, const Tube& tube) {
    tube_[point] = tube;
    lane_tubes_[point] = tube.in_lanes();
  }
  double beyond_for_itself(std::uint32_t slot, double length_of_way) const;
  void lay_vertex(std::uint32_t point);
  void find_reach();
  /// m, beyond its straight way, and no more than `by`.
  double strays(std::uint32_t slot, double by) const;
  /// In shares of the step.
  double tubes_end(double end) const;
  void write_box(std::size_t point, double reach);

  std::vector<std::uint32_t> particles_;  // slots; the others are padding
  kernels::Vector origin_{};
  double largest_reach_ = 0;
  ContactSpeeds speeds_;
  kernels::Vector drift_{};                                     // m, of all in the interval
  double largest_way_ = 0, way_of_bodies_ = 0, travelled_ = 0;  // m, beside that
  double way_of_near_ = 0;  // m, of bodies that the cloth may come to
  float rounding_ = 0, rounding_of_vertices_ = 0;
  SparseArray<kernels::Vector> start_, end_;
  std::vector<double> reach_, ways_;  // per slot
  SparseArray<Box> box_;
  SparseArray<Tube> tube_;
  SparseArray<simd::PointTube> lane_tubes_;
  bool has_tubes_ = false;
  double from_ = 0, to_ = 0, until_ = 0;  // shares of the step: of the interval, and to its end
  double laid_from_ = 0;                  // likewise: when tubes were laid
  double time_left_ = 0;                  // s, until the step ends
  std::uint32_t layings_ = 0;
  SparseArray<std::uint32_t> laid_;  // per vertex: in which its tube was made
  std::uint32_t placings_ = 0;
  SparseArray<std::uint32_t> placed_;    // per vertex: ContactSurface::placing when it was placed
  std::vector<std::uint32_t> active_;    // vertices
  SparseArray<std::uint8_t> is_active_;  // per vertex
  SparseArray<float> start_quads_, way_quads_;
};

template <class Moved>
void ContactPoints::renew_tubes(Moved&& moved) {
  const double length = until_ - laid_from_;
  const Tube::Part part(length > 0 ? (from_ - laid_from_) / length : 0,
                        length > 0 ? (to_ - laid_from_) / length : 0);
  for (const std::uint32_t slot : particles_) {
    if (part.of(tube_[slot]).hold(box_[slot])) continue;
    set_tube(slot, tube_around(slot));
    moved(slot);
  }
}

}  // namespace weft
