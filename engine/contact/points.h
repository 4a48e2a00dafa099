/// The points whose features may touch, in an interval of some substeps: the slots of the cloth,
/// and then the vertices of each body that is a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/particles.h"
#include "engine/contact/side_normals.h"
#include "engine/model/model.h"
#include "engine/triangles/box_tree.h"
#include "kernels/vectors.h"

namespace weft {

/// A body that is a mesh, in the present frame.
struct ContactMesh {
  std::size_t body = 0;  // its place among the bodies of the clock
  std::shared_ptr<const BodyShape> shape;
  std::uint32_t first_point = 0;
  double thickness = 0;
  BoxTree tree;  // of its triangles, around hulls

  SideNormals normals;     // of a one-sided one
  bool has_moved = false;  // since the last interval began

  const MeshShape& mesh() const { return *shape->mesh(); }
};

class ContactPoints {
 public:
  /// Of a frame.
  void begin(const Model& model, const BodyClock& clock);
  const std::vector<ContactMesh>& meshes() const { return meshes_; }
  std::vector<ContactMesh>& meshes() { return meshes_; }
  std::size_t slots() const { return slots_; }
  bool is_of_cloth(std::uint32_t point) const { return point < slots_; }

  /// Of an interval, whose first substep is predicted. All that follows from it does so from the
  /// state alone, whatever was looked for before.
  void begin_interval(const Model& model, const ContactParticles& cloth, const BodyClock& clock,
                      int substeps);
  /// m, that a point may come off the way that it is expected to take: a share of the ways that its
  /// neighbours take, and that bodies do, for these may take it along.
  double reach(std::uint32_t point) const { return point < slots_ ? reach_[point] : 0; }
  double largest_reach() const { return largest_reach_; }
  kernels::Vector way(std::uint32_t point) const { return end_[point] - start_[point]; }
  /// m/s, of the vertices in this step, at most.
  double fastest(const BodyClock& clock) const;
  double largest_thickness() const { return largest_thickness_; }
  kernels::Vector origin() const { return origin_; }
  /// Where the point was when the interval began.
  kernels::Vector start(std::uint32_t point) const { return start_[point]; }
  /// What holds all places that it is expected to come to in the interval.
  const Box& box(std::uint32_t point) const { return box_[point]; }
  /// What held those of some intervals when the broad phase looked.
  const Box& hull(std::uint32_t point) const { return hull_[point]; }
  bool has_hulls() const { return has_hulls_; }
  void renew_hulls();
  /// Renews those of cloth that hold no longer; moved(slot), of each. Returns whether those of
  /// bodies do.
  template <class Moved>
  bool renew_hulls_of_cloth(Moved&& moved);
  /// They hold no longer.
  void forget_hulls() { has_hulls_ = false; }
  /// In quads, from the origin.
  const float* starts() const { return start_quads_.data(); }
  const float* ways() const { return way_quads_.data(); }

  /// These points alone are asked for in the substeps of the interval.
  void ask_for(std::span<const std::uint32_t> points) {
    asked_.assign(points.begin(), points.end());
  }
  /// Where vertices that are asked for are when the present substep begins and ends.
  void place_vertices_asked(const BodyClock& clock);
  /// Where those of the cloth have come to.
  void read_cloth(const ContactParticles& cloth);
  const float* places() const { return place_quads_.data(); }
  void set_place(std::uint32_t point, kernels::Vector x) {
    write(place_quads_, point, x - origin_);
  }
  /// Of a vertex that was asked for, where the substep begins and ends.
  kernels::Vector from(std::uint32_t point) const { return from_[point - slots_]; }
  kernels::Vector to(std::uint32_t point) const { return to_[point - slots_]; }

  /// Where any vertex is when the present substep ends.
  kernels::Vector vertex_now(const BodyClock& clock, std::uint32_t point) const {
    const ContactMesh& mesh = meshes_[mesh_of_[point - slots_]];
    return clock.vertex(mesh.body, point - mesh.first_point, clock.motions()[mesh.body].to,
                        clock.share_after(0));
  }

  /// From the start of the interval to now, of all points, in quads.
  void measure_moves(const Model& model, const ContactParticles& cloth, const BodyClock& clock);
  const float* moves() const { return way_quads_.data(); }
  /// Where a point is now, once moves are measured.
  kernels::Vector end(std::uint32_t point) const { return end_[point]; }
  void set_end(std::uint32_t point, kernels::Vector x);
  /// Whether the point came to a place that was expected.
  bool holds_end(std::uint32_t point) const;
  /// Whether all particles are now where they were expected in the interval.
  bool hold(const Model& model, const ContactParticles& cloth) const;
  /// Makes the box of a point hold its way.
  void take_way_in(std::uint32_t point);
  /// m, of quads.
  float rounding() const { return rounding_; }
  std::size_t bytes() const;

 private:
  static void write(kernels::AlignedVector<float>& quads, std::size_t point, kernels::Vector v) {
    quads[4 * point] = static_cast<float>(v.x);
    quads[4 * point + 1] = static_cast<float>(v.y);
    quads[4 * point + 2] = static_cast<float>(v.z);
  }
  bool holds(std::uint32_t point, kernels::Vector place) const;
  void note_moves(const BodyClock& clock);
  void place_vertices(const BodyClock& clock, int substeps, std::vector<kernels::Vector>& to) const;
  Box hull_around(std::size_t point) const;
  void find_reach(const TriangleSurface& cloth);
  void write_boxes();

  std::size_t slots_ = 0;
  std::vector<ContactMesh> meshes_;
  std::vector<std::uint32_t> mesh_of_;  // per vertex
  kernels::Vector origin_{};
  double largest_reach_ = 0, largest_thickness_ = 0;
  float rounding_ = 0;
  std::vector<kernels::Vector> start_, end_;
  std::vector<double> reach_, ways_;  // per slot
  std::vector<Box> box_, hull_;
  bool has_hulls_ = false;
  kernels::AlignedVector<float> start_quads_, way_quads_, place_quads_;
  std::vector<std::uint32_t> asked_;
  std::vector<kernels::Vector> from_, to_;  // per vertex
};

template <class Moved>
bool ContactPoints::renew_hulls_of_cloth(Moved&& moved) {
  for (std::size_t point = slots_; point < box_.size(); ++point) {
    if (!hull_[point].holds(box_[point])) return false;
  }
  for (std::uint32_t slot = 0; slot < slots_; ++slot) {
    if (hull_[slot].holds(box_[slot])) continue;
    hull_[slot] = hull_around(slot);
    moved(slot);
  }
  return true;
}

}  // namespace weft
