/// Stars of a cloth: the triangles around a point. Nearly all features that are near each other in
/// cloth that touches itself nowhere stand in one star. They come near only where the star folds.
///
/// A star that goes all around its point does not cross itself while all its triangles face one
/// direction: along it the star is laid into a plane without a fold. Points move on straight lines,
/// and the area vector of a triangle is a polynomial of second degree in time. So three dot
/// products tell for the whole interval whether a triangle faces a direction (Bernstein's form).
/// Other stars, those of borders above all, are candidates always.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/features.h"
#include "engine/contact/points.h"
#include "engine/parallel/team.h"
#include "kernels/simd/contact_data.h"
#include "kernels/simd/table.h"

namespace weft {

/// Whether both features of a pair within the cloth stand in one star.
bool are_in_one_star(const TriangleSurface& cloth, const Pair& pair);

class Stars {
 public:
  explicit Stars(const simd::Table& table) : kernels_(*table.contacts) {}

  bool empty() const { return least_area_.empty(); }
  void make(const ContactPoints& points);
  /// Candidates are looked for anew: no star is among them.
  void begin();
  /// comes_near: an interval begins, and on the way that is expected some triangle has less of its
  /// area along the direction of the star than features need to keep their distance.
  /// crosses: an interval ends, and on the way that points took some triangle has faced away.
  enum class Fold : std::uint8_t { comes_near, crosses };
  /// Adds all pairs of features of stars that fold and are not among the candidates yet. Returns
  /// whether there are any.
  bool add_folded(const ContactPoints& points, Fold fold, Candidates& candidates, Team& team);
  std::size_t bytes() const;

 private:
  void find_least_areas(const ContactPoints& points);
  void put_in_blocks(const TriangleSurface& cloth);
  void find_folded(const ContactPoints& points, Fold fold, Team& team);
  void add(const ContactPoints& points, std::uint32_t star, Candidates& candidates);

  const simd::ContactKernels& kernels_;
  std::vector<float> least_area_;        // m^2, per triangle
  std::vector<std::uint32_t> open_;      // points: their stars do not go all around them
  std::vector<std::uint32_t> rings_;     // points: theirs do
  std::vector<simd::StarBlock> blocks_;  // of rings
  std::vector<std::array<std::uint32_t, kernels::kLanes>> rows_;  // of blocks
  kernels::AlignedVector<simd::TriangleTurn> turns_;              // scratch
  std::vector<std::uint16_t> folded_;                             // per block; scratch
  std::vector<std::uint16_t> listed_;                             // per block: among the candidates
  bool has_open_ = false;                                         // likewise, of open_
  std::vector<std::uint32_t> edges_;                              // of one star; scratch
};

}  // namespace weft
