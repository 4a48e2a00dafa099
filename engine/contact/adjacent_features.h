/// Features of a cloth whose triangles share a corner: nearly all pairs whose boxes meet in cloth
/// that touches itself nowhere. They are always the same, so that they stand in blocks of lanes,
/// and one direction, that from the one to the other where tubes begin, tells most of them apart.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/features.h"
#include "engine/contact/points.h"
#include "engine/parallel/team.h"

namespace weft {

class AdjacentFeatures {
 public:
  explicit AdjacentFeatures(const simd::Table& table) : table_(table) {}

  bool empty() const { return owners_[kBodyLists].empty() && owners_[kBodyLists + 1].empty(); }
  void make(const TriangleSurface& cloth, const SewnPoints& sewn);
  /// Adds those whose tubes meet.
  void find(ContactPoints& points, Candidates& candidates, Team& team);
  /// The same of those with a feature of a triangle that is marked.
  void find_of(ContactPoints& points, std::span<const std::uint8_t> is_marked,
               Candidates& candidates, Team& team);
  std::size_t bytes() const;

 private:
  using Owners = std::array<std::uint32_t, 2>;  // triangles

  void add_features(const TriangleSurface& cloth, const SewnPoints& sewn, std::uint32_t a,
                    std::uint32_t b);
  void add(PairKind kind, std::uint32_t first, std::uint32_t second,
           const std::array<std::uint32_t, 4>& points, const Owners& owners);
  void read_tubes(ContactPoints& points);
  simd::PairMeasure measure_of(const ContactPoints& points, std::size_t list);
  void add_near(std::size_t list, std::size_t block, std::uint32_t bits,
                Candidates& candidates) const;

  const simd::Table& table_;
  Candidates pairs_;
  std::array<std::vector<Owners>, kPairLists> owners_;  // per pair
  kernels::AlignedVector<float> begins_, ways_;         // of tubes, in quads; scratch
  std::vector<std::array<float, kernels::kLanes>> distance_;
  std::vector<std::uint16_t> near_;  // per block of the list in hand; scratch
};

}  // namespace weft
