/// Pairs that may come to touch within a while. All particles are searched once. Then only these
/// pairs are checked, until something has moved too far.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/spheres/sphere_contacts.h"

namespace weft {

class NearbySpherePairs {
 public:
  /// Nothing is known: pairs must be found anew.
  void forget() { spare_ = -1; }
  /// Everything has moved by up to `way` (m) since the pairs were found, or since the last call.
  void move(double way) { spare_ -= way; }
  /// Whether these hold all pairs that may touch after one more such move.
  bool hold_after(double way) const { return way <= spare_; }
  /// Finds all pairs that may touch after moves by up to `margin` (m) in all. Only the scratch of
  /// the contacts is written.
  void find(const Model& model, const simd::Table& kernels, kernels::VectorsView x, double margin,
            SphereContacts& contacts);
  /// Lists those of them that find_contacts() would find at x, in the same order.
  void list_contacts(const Model& model, kernels::VectorsView x, SphereContacts& contacts) const;
  /// Whose places list_contacts() looks at.
  std::span<const std::uint32_t> slots() const { return slots_; }
  std::size_t bytes() const;

 private:
  std::vector<SpherePair> pairs_;
  std::vector<std::uint32_t> slots_;
  double spare_ = -1;  // m, that everything may still move
};

}  // namespace weft
