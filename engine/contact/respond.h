/// Stages 4 to 6 of an interval: in each substep, after the cloth has been swept, pairs that are
/// nearer than the thickness are pushed apart, with friction, along normals of that very moment.
/// Lanes find them, and push a block of them at a time (arrange.h), so that what touches in many
/// places is pushed no farther than it must. Pairs that floats cannot tell are treated in double,
/// one by one: those that are on the wrong side, that meet, or are nearest at a corner. The
/// reference backend treats all like that.
///
/// A touch does what it does with closed forms (kernels/reference/bodies.h): it stops what came
/// nearer in this substep, lets what was deeper come out slowly and without speed, and gives
/// friction what Coulomb's law allows of this substep's push. Here it acts on two features, whose
/// points count by w_i: each is moved by W_i w_i / sum of W_j w_j^2 times that, with W_i its
/// inverse mass. Points of bodies have none: what they do not take loads the body.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/contact/arrange.h"
#include "engine/contact/near_pairs.h"
#include "engine/contact/scene.h"
#include "engine/contact/swept_points.h"
#include "engine/parallel/team.h"
#include "engine/tuning.h"

namespace weft {

/// 1/kg: a lower bound for the sum of W w^2. Where a feature is fixed but for a particle that has a
/// small part in its nearest point, that particle is not thrown far for it.
double least_weight(const ContactPoints& points, const std::array<std::uint32_t, 4>& four);

class Response {
 public:
  Response(const simd::Table& table, bool in_lanes) : table_(table), in_lanes_(in_lanes) {}

  /// Of an interval: arranges its pairs.
  void begin(const ContactScene& scene, Near& near);
  /// Of a substep.
  void advance(const BodyClock& clock, ContactPoints& points, Near& near);
  /// Over all pairs. moved(slot, by): by how much (m).
  template <class Moved>
  void sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved);
  /// Over pairs of the slot that have touched in this substep. Returns whether one was pushed.
  bool hold(const ContactScene& scene, Near& near, std::uint32_t slot);
  /// m, by which a pair is nearer than its thickness.
  double deepest(const ContactScene& scene, Near& near, Team& team);
  /// Since this was last asked: what sweeps took, in visits of a constraint.
  double take_visits() { return std::exchange(visits_, 0); }
  std::size_t bytes() const;

 private:
  /// A sweep goes through all pairs of one turn, then through those of the next.
  enum class Turn : std::uint8_t { points, edges, points_of_bodies };
  /// A pair in the present substep.
  struct Encounter;
  static Encounter meet(const ContactScene& scene, const NearPairs& near, std::size_t i);
  template <class Visit>
  static void for_each_lane(std::size_t block, std::uint32_t bits, Visit&& visit);
  simd::PairTouch touch_of(const ContactScene& scene, NearPairs& near,
                           std::vector<std::uint16_t>& touching) const;
  void ask_for_points(const ContactScene& scene, const Near& near);
  static void write_beside(const ContactScene& scene, NearPairs& near, std::size_t i);
  static bool fits_lanes(const ContactScene& scene, const NearPairs& near, std::size_t i);
  /// The pairs of a block that touch in this turn.
  std::uint32_t touching_in(const NearPairs& near, Turn turn, std::size_t list,
                            std::size_t block) const;
  static std::size_t list_in(Turn turn) { return turn == Turn::edges ? 1 : 0; }
  bool push_in_double(const ContactScene& scene, Near& near, Turn turn);
  bool push_in_lanes(const ContactScene& scene, Near& near, Turn turn);
  simd::PairPush push_of(const ContactScene& scene, NearPairs& near, Turn turn);
  bool resist_beside_lanes(const ContactScene& scene, NearPairs& near, std::size_t i);
  void read_swept(const ContactScene& scene, Near& near);
  void end_sweep(const ContactScene& scene, Near& near);
  static void take_load(const ContactScene& scene, NearPairs& near, std::size_t i);
  /// Returns whether it was pushed apart.
  static bool resist(const ContactScene& scene, NearPairs& near, std::size_t i);
  static void push(const ContactScene& scene, const Encounter& e, const Pair& pair,
                   const reference::Stop& stop, double weight, reference::Grip& grip);
  void find_touching(const ContactScene& scene, Near& near, Team& team);
  void link(const ContactScene& scene, const Near& near);

  const simd::Table& table_;
  bool in_lanes_;
  Arrangement arrangement_;
  SweptPoints swept_;
  /// Per block, a bit per lane: when a sweep began, and as of late.
  std::array<std::vector<std::uint16_t>, kPairLists> touching_, touching_now_;
  std::array<std::vector<std::uint16_t>, kPairLists> pushed_, by_lanes_;  // in a sweep, likewise
  std::vector<std::uint32_t> asked_;                                      // points of near pairs
  std::vector<bool> is_asked_;                                            // per point
  /// Pairs that have touched in this substep, in lists by slot.
  struct Link {
    std::uint32_t list = 0, pair = 0, next = 0;
  };
  std::vector<std::uint32_t> first_link_;  // per slot
  std::vector<Link> links_;
  std::vector<std::uint32_t> linked_;  // slots
  bool are_linked_ = false;
  double visits_ = 0;
};

/// visit(i), of pairs of the block.
template <class Visit>
void Response::for_each_lane(std::size_t block, std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(block * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Particles first: of a pair that is a mean of several, which a push moves all at once, the
/// corners are then where they may be, and what lies flat has nothing left to push.
template <class Moved>
void Response::sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved) {
  find_touching(scene, near, team);
  for (auto& bits : pushed_) std::ranges::fill(bits, std::uint16_t{0});
  for (const NearPairs& pairs : near)
    visits_ += tuning::kVisitsOfLook * static_cast<double>(pairs.list.size());
  if (in_lanes_) read_swept(scene, near);
  bool any = true;
  for (int round = 0; round < tuning::kMeshRounds && any; ++round) {
    any = false;
    for (const Turn turn : {Turn::points, Turn::edges, Turn::points_of_bodies}) {
      const bool pushes =
          in_lanes_ ? push_in_lanes(scene, near, turn) : push_in_double(scene, near, turn);
      any = any || pushes;
    }
  }
  end_sweep(scene, near);
  for (std::size_t list = 0; list < kPairLists; ++list) {
    for (std::size_t block = 0; block < pushed_[list].size(); ++block) {
      for_each_lane(block, pushed_[list][block], [&](std::size_t i) {
        for (const std::uint32_t point : near[list].list.points(i)) {
          if (scene.points.is_of_cloth(point)) moved(point, near[list].push(i));
        }
      });
    }
  }
}

}  // namespace weft
