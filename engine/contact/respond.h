/// Stages 4 to 6 of an interval: after the sweep of each substep, pairs that are nearer than the
/// thickness are pushed apart, with friction, along their present normals. Lanes find these pairs.
/// They are few, and are solved one after the other, so that a feature with many contacts is pushed
/// no farther than necessary.
///
/// The law is that of closed forms (kernels/reference/bodies.h). A contact stops the approach of
/// this substep, lets a deeper penetration come out slowly and without speed, and has Coulomb
/// friction for the push of this substep. Here it acts on two features, whose points have the
/// weights w_i: each moves by W_i w_i / sum of W_j w_j^2 times the correction, with W_i its inverse
/// mass. Points of bodies have none: their share of the impulse loads the body.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/contact/near_pairs.h"
#include "engine/contact/pair_contact.h"
#include "engine/contact/scene.h"
#include "engine/parallel/team.h"
#include "engine/tuning.h"

namespace weft {

/// 1/kg: a lower bound for the sum of W w^2. Where a feature is fixed but for a particle that has a
/// small part in its nearest point, that particle is not thrown far for it.
double least_weight(const ContactPoints& points, const std::array<std::uint32_t, 4>& four);

class Response {
 public:
  explicit Response(const simd::Table& table) : table_(table) {}

  /// Begins an interval.
  void begin(const ContactScene& scene, const Near& near);
  /// Advances by a substep.
  void advance(const ContactScene& scene, Near& near);
  /// Over all pairs. moved(slot, by): by how much (m).
  template <class Moved>
  void sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved);
  /// Beside contacts within the cloth: visits all pairs once. A pair that has pushed too much
  /// takes the excess back.
  template <class Moved>
  void round(const ContactScene& scene, Near& near, Team& team, Moved&& moved);
  /// The surface that has pushed a particle most in this substep, of all that it touches, and its
  /// normal.
  std::pair<TouchedSurface, kernels::Vector> touched_by(const ContactPoints& points,
                                                        const PresentPoints& present,
                                                        const Near& near, std::uint32_t slot) const;
  /// Solves pairs of the slot that have touched in this substep. Returns whether one was pushed.
  bool solve_at(const ContactScene& scene, Near& near, std::uint32_t slot);
  /// m, by which a pair is nearer than its thickness.
  double deepest(const ContactScene& scene, Near& near, Team& team);
  /// Since this was last asked: what sweeps took, in visits of a constraint.
  double take_visits() { return std::exchange(visits_, 0); }
  std::size_t bytes() const;

 private:
  /// A sweep goes through all pairs of one turn, then through those of the next.
  enum class Turn : std::uint8_t { points, edges, points_of_bodies };
  static PairContact contact_of(const ContactScene& scene, const NearPairs& near, std::size_t i);
  template <class Visit>
  static void for_each_lane(std::size_t block, std::uint32_t bits, Visit&& visit);
  simd::PairTouch touch_of(const ContactScene& scene, NearPairs& near,
                           std::vector<std::uint16_t>& touching) const;
  static constexpr float kRoundings = 4;  // of a point, in a distance
  /// Returns the longest push (m).
  template <class Moved>
  double push_apart(const ContactScene& scene, Near& near, Turn turn, Moved& moved);
  /// Returns whether it was pushed apart.
  void take_back_excess(const ContactScene& scene, Near& near) const;
  static bool solve(const ContactScene& scene, NearPairs& near, std::size_t i);
  static void apply(const ContactScene& scene, const PairContact& e, const Pair& pair,
                    const reference::Stop& stop, const reference::Slowed& slow);
  void find_touching(const ContactScene& scene, Near& near, Team& team);
  void remember(const ContactScene& scene, NearPairs& near, std::size_t list, std::size_t i);

  const simd::Table& table_;
  /// Per block, a bit per lane: when a sweep began, and as of late.
  std::array<std::vector<std::uint16_t>, kBodyLists> touching_, touching_now_;
  std::vector<std::uint32_t> asked_;  // points of near pairs
  std::vector<bool> is_asked_;        // per point
  /// Pairs that have touched in this substep, in lists by slot.
  struct Link {
    std::uint32_t list = 0, pair = 0, next = 0;
  };
  std::vector<std::uint32_t> first_link_;  // per slot
  std::vector<Link> links_;
  std::vector<std::uint32_t> linked_;  // slots
  double visits_ = 0;
};

/// visit(i), of pairs of the block.
template <class Visit>
void Response::for_each_lane(std::size_t block, std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(block * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Most pairs that touched when the sweep began do so no longer once others were pushed: lanes tell
/// which do, block by block, and these alone are looked at in double.
///
/// Particles first: of a pair that is a mean of several, which a push moves all at once, the
/// corners are then where they may be, and what lies flat has nothing left to push.
///
/// Two faces that meet over a corner of a body, as a tent does over its pole, are pushed to either
/// side of it by points that both share: the steeper they are, the more turns lift their edge.
template <class Moved>
void Response::sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved) {
  find_touching(scene, near, team);
  for (const NearPairs& pairs : near)
    visits_ += tuning::kVisitsOfLook * static_cast<double>(pairs.list.size());
  double pushed = 0;
  for (int round = 0; round < tuning::kMeshRounds; ++round) {
    for (const Turn turn : {Turn::points, Turn::edges, Turn::points_of_bodies})
      pushed = push_apart(scene, near, turn, moved);
  }
  for (int turn = 0; turn < tuning::kCornerTurns && pushed > tuning::kCornerPush; ++turn)
    pushed = push_apart(scene, near, Turn::points_of_bodies, moved);
}

template <class Moved>
void Response::round(const ContactScene& scene, Near& near, Team& team, Moved&& moved) {
  if (near[0].list.size() + near[1].list.size() == 0) return;
  find_touching(scene, near, team);
  for (const Turn turn : {Turn::points, Turn::edges, Turn::points_of_bodies})
    push_apart(scene, near, turn, moved);
  take_back_excess(scene, near);
}

template <class Moved>
double Response::push_apart(const ContactScene& scene, Near& near, Turn turn, Moved& moved) {
  const std::size_t list = turn == Turn::edges ? 1 : 0;
  NearPairs& pairs = near[list];
  const simd::PairTouch touch = touch_of(scene, pairs, touching_now_[list]);
  double longest = 0;
  for (std::size_t block = 0; block < touching_[list].size(); ++block) {
    const std::uint32_t turned = pairs.turned[block];
    const std::uint32_t bits =
        touching_[list][block] & (turn == Turn::points_of_bodies ? turned : ~turned);
    if (bits == 0) continue;
    table_.touch_pairs(touch, has_edges(list), block, block + 1);
    for_each_lane(block, bits & touching_now_[list][block], [&](std::size_t i) {
      visits_ += tuning::kVisitsOfTouch;
      const double before = pairs.states[i].push;
      if (!solve(scene, pairs, i)) return;
      longest = std::max(longest, pairs.states[i].push - before);
      remember(scene, pairs, list, i);
      for (const std::uint32_t point : pairs.list.points(i)) {
        if (scene.points.is_of_cloth(point)) moved(point, pairs.states[i].push);
      }
    });
  }
  return longest;
}

}  // namespace weft
