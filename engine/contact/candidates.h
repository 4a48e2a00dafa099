/// Stage 2 of an interval finds the candidates: pairs of features that may meet at all. The search
/// is done once a step, by tubes, which hold all places to which points are expected to come until
/// it ends. When the next interval begins, only candidates of triangles whose corners have left
/// their tubes are renewed. Points that leave the boxes of an interval are searched when it ends
/// (verify.h). So candidates follow from the state in which a step begins.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/contact/features.h"
#include "engine/contact/points.h"
#include "engine/contact/stars.h"

namespace weft {

/// Tubes of the cloth as the tree of a body has them. Six triangles share a corner.
class SeenTubes {
 public:
  void resize(std::size_t points) {
    boxes_.resize(points);
    seen_for_.resize(points);
  }
  /// Begins with the body that comes next.
  void begin() { ++bodies_; }
  /// All of a triangle.
  Box box(ContactPoints& points, const ContactSurface& body,
          const TriangleSurface::Triangle& corners);
  std::size_t bytes() const { return bytes_of(boxes_) + bytes_of(seen_for_); }

 private:
  std::vector<Box> boxes_;
  std::vector<std::uint64_t> seen_for_;
  std::uint64_t bodies_ = 0;
};

class CandidateSearch {
 public:
  explicit CandidateSearch(const simd::Table& table) : table_(table), stars_(table) {}

  /// Finds candidates of an interval. Returns whether candidates have other places than before.
  bool find(ContactPoints& points, Candidates& candidates, Team& team);
  /// Adds candidates of a triangle of the cloth within a box of its own.
  void find_beside(ContactPoints& points, std::uint32_t triangle, const Box& box,
                   Candidates& candidates) const;
  /// The same beside other cloth, of all triangles that have such a corner, by the tubes of their
  /// corners: those are widened to the way that it took.
  void find_within_cloth_beside(ContactPoints& points, std::span<const std::uint8_t> has_strayed,
                                Candidates& candidates);
  /// Adds candidates of stars that have folded on their way in the interval. Returns whether there
  /// are any.
  bool find_folded(ContactPoints& points, Candidates& candidates, Team& team) {
    return stars_.add_folded(points, Stars::Fold::crosses, candidates, team);
  }
  std::size_t bytes() const;

 private:
  void find_all(ContactPoints& points, SurfacePair pair, Candidates& candidates);
  void find_within_cloth(ContactPoints& points, Candidates& candidates);
  void find_within_cloth_of(ContactPoints& points, Candidates& candidates);
  bool find_again(ContactPoints& points, Candidates& candidates);
  void find_owners(const ContactSurface& cloth);
  std::uint32_t owner(const Pair& pair) const;
  std::uint32_t owner_of_second(const Pair& pair) const;
  bool renew(ContactPoints& points, Candidates& candidates);

  const simd::Table& table_;
  BoxTree seen_cloth_;                                         // in coordinates of a body; scratch
  SeenTubes seen_;                                             // scratch
  Stars stars_;                                                // of the cloth
  std::vector<std::uint32_t> owner_of_edge_, owner_of_point_;  // triangles of the cloth
  std::vector<std::uint8_t> has_moved_;                        // per slot, out of its tube; scratch
  std::vector<std::uint8_t> is_renewed_;                       // per triangle of the cloth; scratch
};

}  // namespace weft
