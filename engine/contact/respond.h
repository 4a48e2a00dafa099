/// Stages 4 to 6 of contacts with meshes: in each substep, after the cloth has been swept, pairs
/// that are nearer than the thickness are pushed apart, with friction, along normals of that very
/// moment. Lanes find them; they are few, and are treated one after the other, so that what touches
/// in many places is pushed no farther than it must.
///
/// What a contact does is that of closed forms (kernels/reference/bodies.h): it stops what came
/// nearer in this substep, lets what was deeper come out slowly and without speed, and gives
/// friction what Coulomb's law allows of this substep's push. Here it acts on a point of the cloth
/// that is a mean of up to three particles, w_i: each is moved by W_i w_i / sum of W_j w_j^2 times
/// that, with W_i its inverse mass.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/bodies.h"
#include "engine/contact/misplaced.h"
#include "engine/contact/near.h"
#include "engine/contact/particles.h"
#include "engine/contact/tangles.h"
#include "engine/tuning.h"

namespace weft {

/// What contacts have given to the cloth, per body of the clock.
struct ContactImpulses {
  std::vector<BodyImpulse> of_body;
  double work = 0;      // J, that bodies did
  double friction = 0;  // J, that it took

  /// An impulse at x on a surface that moves with `velocity`.
  void add(std::size_t body, kernels::Vector centre, kernels::Vector x, kernels::Vector impulse,
           kernels::Vector velocity) {
    of_body[body].linear = of_body[body].linear + impulse;
    of_body[body].angular = of_body[body].angular + cross(x - centre, impulse);
    work += dot(impulse, velocity);
  }
  void begin(std::span<const TravellingBody> bodies) {
    of_body.clear();
    for (const TravellingBody& body : bodies) of_body.push_back({.id = body.id});
    work = friction = 0;
  }
};

/// What a sweep needs to know of a substep.
struct ContactScene {
  const Model& model;
  const TriangleSurface& cloth;
  const BodyClock& clock;
  ContactPoints& points;
  ContactParticles& particles;
  ContactImpulses& impulses;
  const Misplaced& misplaced;
  const Tangles& tangles;
};

/// 1/kg: a lower bound for the sum of W w^2. Where a feature is fixed but for a particle that has a
/// small part in its nearest point, that particle is not thrown far for it.
double least_weight(const Model& model, const std::array<std::uint32_t, 4>& points,
                    const ContactPoints& of);

class Response {
 public:
  explicit Response(const simd::Table& table) : table_(table) {}

  /// Of an interval.
  void begin(const ContactScene& scene, const Near& near);
  /// Of a substep.
  void advance(const BodyClock& clock, ContactPoints& points, Near& near);
  /// Over all pairs. moved(slot, by): by how much (m).
  template <class Moved>
  void sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved);
  /// Over pairs of the slot that have touched in this substep. Returns whether one was pushed.
  bool hold(const ContactScene& scene, Near& near, std::uint32_t slot);
  /// Slots that have touched in this substep.
  const std::vector<std::uint32_t>& touching() const { return linked_; }
  /// m, by which a pair is nearer than its thickness.
  double deepest(const ContactScene& scene, Near& near, Team& team);
  std::size_t bytes() const;

 private:
  template <class Moved>
  void push_apart(const ContactScene& scene, Near& near, PairKind kind, Moved& moved);
  /// Returns whether it was pushed apart.
  bool resist(const ContactScene& scene, NearPairs& near, std::size_t i);
  void find_touching(const ContactScene& scene, Near& near, Team& team);
  double depth_of(const ContactScene& scene, const NearPairs& near, std::size_t i) const;
  void remember(const ContactScene& scene, NearPairs& near, std::size_t list, std::size_t i);

  const simd::Table& table_;
  std::array<std::vector<std::uint16_t>, kPairLists> touching_;  // per block, a bit per lane
  std::vector<std::uint32_t> asked_;                             // points of near pairs
  std::vector<bool> is_asked_;                                   // per point
  /// Pairs that have touched in this substep, in lists by slot.
  struct Link {
    std::uint32_t list = 0, pair = 0, next = 0;
  };
  std::vector<std::uint32_t> first_link_;  // per slot
  std::vector<Link> links_;
  std::vector<std::uint32_t> linked_;  // slots
};

/// Particles first: of a pair that is a mean of several, which a push moves all at once, the
/// corners are then where they may be, and what lies flat has nothing left to push.
template <class Moved>
void Response::sweep(const ContactScene& scene, Near& near, Team& team, Moved&& moved) {
  find_touching(scene, near, team);
  for (int round = 0; round < tuning::kMeshRounds; ++round) {
    for (const PairKind kind :
         {PairKind::particle_triangle, PairKind::edges, PairKind::vertex_triangle})
      push_apart(scene, near, kind, moved);
  }
}

template <class Moved>
void Response::push_apart(const ContactScene& scene, Near& near, PairKind kind, Moved& moved) {
  const std::size_t list = list_of(kind);
  for (std::size_t block = 0; block < touching_[list].size(); ++block) {
    for (std::uint32_t bits = touching_[list][block]; bits != 0; bits &= bits - 1) {
      const std::size_t i =
          block * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(bits));
      if (near[list].list.pairs[i].kind != kind || !resist(scene, near[list], i)) continue;
      remember(scene, near[list], list, i);
      for (const std::uint32_t point : near[list].list.points(i)) {
        if (scene.points.is_of_cloth(point)) moved(point, near[list].states[i].push);
      }
    }
  }
}

}  // namespace weft
