/// Which pairs may touch in this step. Contacts exist between the spheres of a scene and all other
/// particles, pairs joined by a constraint excepted.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/contacts/contact_boxes.h"
#include "engine/model/model.h"
#include "kernels/simd/table.h"

namespace weft {

/// Pairs near enough to touch in this step, and for each slot the list of its contacts. Spheres and
/// particles are slots; in a pair of spheres the lower slot is the sphere.
struct ContactStore {
  std::vector<std::uint32_t> sphere, particle;
  std::vector<double> distance;      // r1 + r2
  std::vector<std::uint32_t> first;  // per slot, kNoIndex ends a list
  std::vector<std::uint32_t> next;   // per contact
  std::vector<std::uint32_t> found;  // scratch of the search, per slot
  ContactBoxes boxes;                // likewise

  std::uint32_t count() const { return static_cast<std::uint32_t>(sphere.size()); }
  std::size_t capacity() const { return sphere.capacity(); }  // of the list that grows last
  std::size_t bytes() const;
};

/// An empty store with room for the search; without spheres nothing is allocated.
ContactStore make_contact_store(const Model& model);

/// Whether they collide where they meet (slots). A pair of spheres is seen once, with the lower
/// slot as the sphere; pairs that cannot move do not collide.
bool may_touch(const Model& model, std::uint32_t sphere, std::uint32_t particle);

/// Lists every pair whose distance at x is below r1 + r2 plus a twentieth of the sphere's radius.
void find_contacts(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                   ContactStore& contacts);

/// After a solve: lists the pairs that it pushed into each other, deeper than the tolerance, from
/// beyond that margin. Returns how many; if any, the positions must be solved again.
std::size_t add_missed_contacts(const Model& model, const simd::Table& kernels,
                                kernels::VectorsView x, double tolerance, ContactStore& contacts);

/// Deepest r1 + r2 - |a - b| over all pairs, 0 if none overlaps.
double max_penetration(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                       ContactStore& contacts);

}  // namespace weft
