/// Pairs that may touch in this step. Contacts exist between the spheres of a scene and all other
/// particles, except pairs joined by a constraint.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/spheres/slot_boxes.h"
#include "kernels/simd/table.h"

namespace weft {

/// Slots.
struct SpherePair {
  std::uint32_t sphere = 0, particle = 0;
  bool operator==(const SpherePair&) const = default;
};

/// Pairs near enough to touch in this step, and for each slot the list of its contacts. Spheres and
/// particles are slots; in a pair of spheres the lower slot is the sphere.
struct SphereContacts {
  std::vector<std::uint32_t> sphere, particle;
  std::vector<double> distance;      // r1 + r2
  std::vector<std::uint32_t> first;  // per slot, kNoIndex ends a list
  std::vector<std::uint32_t> next;   // per contact
  std::vector<std::uint8_t> met;     // per slot, whether it was in a list since the step began
  std::vector<std::uint32_t> found;  // scratch of the search, per slot
  SlotBoxes boxes;                   // likewise

  /// Empties the list.
  void clear();
  void add(SpherePair pair, double distance);

  std::uint32_t count() const { return static_cast<std::uint32_t>(sphere.size()); }
  std::size_t capacity() const { return sphere.capacity(); }  // of the list that grows last
  std::size_t bytes() const;
};

/// An empty store with room for the search; without spheres nothing is allocated.
SphereContacts make_sphere_contacts(const Model& model);

/// Whether they collide where they meet (slots). A pair of spheres is seen once, with the lower
/// slot as the sphere; pairs that cannot move do not collide.
bool may_touch(const Model& model, std::uint32_t sphere, std::uint32_t particle);

/// Lists every pair whose distance at x is below r1 + r2 plus a twentieth of the sphere's radius.
void find_contacts(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                   SphereContacts& contacts);

/// m, between the centres of a pair, below which find_contacts() lists it.
double reach_of(const Model& model, SpherePair pair);

/// All pairs that find_contacts() would list if both came nearer by up to `margin` (m) each, in its
/// order. Only the scratch of the contacts is written.
void find_pairs(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                double margin, SphereContacts& contacts, std::vector<SpherePair>& pairs);

/// Whether the slot is that of a sphere that has met nothing in this step, and is joined to
/// nothing.
bool touches_nothing(const Model& model, const SphereContacts& contacts, std::uint32_t slot);

/// After a solve: lists the pairs that it pushed into each other, deeper than the tolerance, from
/// beyond that margin. Returns how many; if any, the positions must be solved again.
std::size_t add_missed_contacts(const Model& model, const simd::Table& kernels,
                                kernels::VectorsView x, double tolerance, SphereContacts& contacts);

/// Deepest r1 + r2 - |a - b| over all pairs, 0 if none overlaps.
double max_penetration(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                       SphereContacts& contacts);

}  // namespace weft
