/// The surfaces that may touch, and the numbers of their points: the slots of the cloth, and then
/// the vertices of each body that is a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/features.h"
#include "engine/contact/look.h"
#include "engine/contact/rest_distances.h"
#include "engine/contact/sewn_points.h"
#include "engine/contact/surface.h"
#include "engine/model/model.h"

namespace weft {

class ContactSurfaces {
 public:
  explicit ContactSurfaces(const Model& model) : model_(model) {}

  /// Begins a frame. Returns whether points have other numbers than in the last one.
  bool begin(const BodyClock& clock);
  const Model& model() const { return model_; }
  /// The cloth's first, where there is something to touch.
  const std::vector<ContactSurface>& surfaces() const { return surfaces_; }
  std::vector<ContactSurface>& surfaces() { return surfaces_; }
  std::span<ContactSurface> of_bodies() {
    return std::span(surfaces_).subspan(std::min<std::size_t>(1, surfaces_.size()));
  }
  std::span<const ContactSurface> of_bodies() const {
    return std::span(surfaces_).subspan(std::min<std::size_t>(1, surfaces_.size()));
  }
  const TriangleSurface& cloth() const { return *surfaces_[kClothSurface].triangles; }
  /// Which of them may touch: the cloth and each body. Besides, the cloth itself may.
  const std::vector<SurfacePair>& surface_pairs() const { return surface_pairs_; }
  bool touches_itself() const { return touches_itself_; }
  bool empty() const { return surface_pairs_.empty() && !touches_itself_; }
  double largest_thickness() const { return largest_thickness_; }
  /// m, that the features of a pair keep from each other.
  double thickness_of(const Pair& pair) const {
    return pair.is_within_cloth() ? rest_.of(pair) : later(pair).thickness;
  }
  /// Sewn points of the cloth.
  const SewnPoints& sewn() const { return sewn_; }
  const ContactSurface& later(const Pair& pair) const { return later_surface(surfaces_, pair); }
  ContactSurface& later(const Pair& pair) { return later_surface(surfaces_, pair); }
  /// m: the shortest edge of a particle.
  double shortest_edge(std::uint32_t slot) const { return shortest_[slot]; }

  std::size_t slots() const { return slots_; }
  /// The number of all points.
  std::size_t count() const { return slots_ + surface_of_.size(); }
  bool is_of_cloth(std::uint32_t point) const { return point < slots_; }
  /// The surface of a vertex of a body.
  const ContactSurface& surface_of(std::uint32_t point) const {
    return surfaces_[surface_of_[point - slots_]];
  }
  /// 1/kg; 0 of the vertices of bodies.
  double inverse_mass(std::uint32_t point) const {
    return is_of_cloth(point) ? model_.inverse_mass[point] : 0;
  }
  double largest_inverse_mass(const std::array<std::uint32_t, 4>& points) const {
    double largest = 0;
    for (const std::uint32_t point : points) largest = std::max(largest, inverse_mass(point));
    return largest;
  }
  std::size_t bytes() const;

 private:
  void add_cloth();
  void prepare_for_itself();
  ContactSurface& surface_for(const BodyClock& clock, std::size_t body, std::size_t place);
  static void take_vertices(ContactSurface& surface, const TravellingBody& body);

  const Model& model_;
  std::size_t slots_ = 0;
  bool touches_itself_ = false;
  SewnPoints sewn_;
  RestDistances rest_;
  std::vector<ContactSurface> surfaces_;
  std::vector<SurfacePair> surface_pairs_;
  std::vector<std::uint16_t> surface_of_;  // per vertex
  std::vector<double> shortest_;           // per slot
  double largest_thickness_ = 0;
};

}  // namespace weft
