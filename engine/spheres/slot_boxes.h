/// Boxes around groups of particles, so that a sphere is compared only with particles that it may
/// meet.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "engine/model/model.h"
#include "kernels/simd/table.h"

namespace weft {

/// Made anew for each search. Without boxes, where the spheres are too few to pay for them, all
/// slots are searched.
class SlotBoxes {
 public:
  SlotBoxes() = default;
  explicit SlotBoxes(const Model& model);

  /// Each box holds all places of its particles.
  void enclose(const Model& model, const simd::Table& kernels,
               std::initializer_list<kernels::VectorsView> places);

  /// Calls visit(first, last) for ranges of slots, in ascending order, that have all particles
  /// nearer than radius + extra to the box which holds `from` and `to`.
  template <class Visit>
  void visit_near(const Model& model, const simd::Table& kernels, kernels::Vector from,
                  kernels::Vector to, double extra, Visit&& visit) {
    if (near_.empty()) return visit(std::size_t{0}, model.slots());
    const std::size_t near = find(kernels, from, to, extra);
    for (std::size_t i = 0; i < near; ++i) {
      const std::size_t first = near_[i] * simd::kBoxed;
      visit(first, std::min(first + simd::kBoxed, model.slots()));
    }
  }

  std::size_t bytes() const;

 private:
  simd::Boxes boxes();
  std::size_t find(const simd::Table& kernels, kernels::Vector from, kernels::Vector to,
                   double extra);

  kernels::Vectors low_, high_;
  kernels::AlignedVector<double> reach_;  // largest radius, per box
  std::vector<std::uint32_t> near_;       // scratch; empty: no boxes
};

}  // namespace weft
