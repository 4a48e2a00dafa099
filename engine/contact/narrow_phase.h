/// Stage 3 of contacts with meshes: which candidates may touch within the interval. Their distance
/// is measured once, in lanes; near are those that come nearer than the thickness if points go on
/// as expected, but for the reach.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/broad_phase.h"
#include "engine/parallel/team.h"
#include "kernels/reference/bodies.h"

namespace weft {

/// What is known of a list of candidates.
struct Distances {
  std::vector<std::array<float, kernels::kLanes>> distance;  // m, when the interval begins
  std::vector<std::uint16_t> near;                           // per block, a bit per lane

  void resize(std::size_t blocks) {
    distance.resize(blocks);
    near.resize(blocks);
  }
};

/// A pair that may touch in this interval, and what its contact has done in the present substep.
struct NearState {
  bool is_under = false;     // the cloth is on the wrong side
  bool is_touching = false;  // in this substep
  double push = 0;           // m, along the normal, in this substep
  reference::Grip grip{};
};

/// Near pairs of one list.
struct NearPairs {
  PairList list;
  kernels::AlignedVector<simd::PairSide> sides;  // per block
  std::vector<NearState> states;                 // per pair

  void clear() {
    list.clear();
    sides.clear();
    states.clear();
  }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points, kernels::Vector normal,
           double thickness, bool is_under);
  /// From the second feature to the first, as last seen there.
  kernels::Vector normal(std::size_t i) const;
  void set_normal(std::size_t i, kernels::Vector normal);
};
using Near = std::array<NearPairs, kPairLists>;

class NarrowPhase {
 public:
  explicit NarrowPhase(const simd::Table& table) : table_(table) {}

  void measure(const ContactPoints& points, const Candidates& candidates, Team& team);
  /// is_inside(slot): the particle is known to be on the wrong side of a one-sided body. Pairs of
  /// others with a surface that the cloth is behind are left out: it lies beside another one there.
  template <class IsInside>
  void find_near(const Model& model, ContactPoints& points, const Candidates& candidates,
                 Near& near, IsInside&& is_inside) const;
  const std::array<Distances, kPairLists>& distances() const { return distances_; }
  std::array<Distances, kPairLists>& distances() { return distances_; }
  std::size_t bytes() const;

 private:
  static bool can_move(const Model& model, const Pair& pair,
                       const std::array<std::uint32_t, 4>& points);
  static bool may_meet(const ContactPoints& points, PairKind kind,
                       const std::array<std::uint32_t, 4>& four);
  static double closing(const ContactPoints& points, PairKind kind,
                        const std::array<std::uint32_t, 4>& four, kernels::Vector n);
  /// Whether it is to be looked at; sets the normal and whether it is under.
  static bool see(const Model& model, ContactPoints& points, const Pair& pair,
                  const std::array<std::uint32_t, 4>& four, bool is_inside, kernels::Vector& normal,
                  bool& is_under);

  const simd::Table& table_;
  std::array<Distances, kPairLists> distances_;
};

template <class IsInside>
void NarrowPhase::find_near(const Model& model, ContactPoints& points, const Candidates& candidates,
                            Near& near, IsInside&& is_inside) const {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    near[list].clear();
    const PairList& pairs = candidates[list];
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if ((distances_[list].near[i / kernels::kLanes] >> i % kernels::kLanes & 1) == 0) continue;
      const Pair& pair = pairs.pairs[i];
      const std::array<std::uint32_t, 4> four = pairs.points(i);
      const bool inside = std::ranges::any_of(
          four, [&](std::uint32_t point) { return points.is_of_cloth(point) && is_inside(point); });
      // Faces and edges between particles that are inside follow these.
      if (inside && pair.kind != PairKind::particle_triangle) continue;
      kernels::Vector normal{};
      bool is_under = false;
      if (!see(model, points, pair, four, inside, normal, is_under)) continue;
      near[list].add(pair, four, normal, points.meshes()[pair.mesh].thickness, is_under);
    }
  }
}

}  // namespace weft
