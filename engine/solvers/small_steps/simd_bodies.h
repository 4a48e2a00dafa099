/// Particles beside bodies, in lanes (kernels/simd/bodies.h).
///
/// Which blocks of particles a body may meet is looked for once an interval of some substeps, from
/// boxes around where they are and where they are going; contacts are found and solved in every
/// substep, after each sweep.
#pragma once

#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/interval.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/body_layout.h"
#include "engine/solvers/small_steps/body_report.h"
#include "engine/tuning.h"
#include "kernels/simd/table.h"

namespace weft {

class SimdBodies {
 public:
  SimdBodies(const Model& model, const Settings& settings, const simd::Table& table)
      : model_(model),
        far_(tuning::kLocalShare * settings.tolerance),
        contact_tolerance_(settings.contact_tolerance),
        table_(table),
        meshes_(model, table, shares_) {}

  /// The particles that touched a body when the last substep of a frame ended, per block.
  using Touching = std::vector<std::uint16_t>;

  bool empty() const { return clock_.bodies().empty() && meshes_.empty(); }
  bool has_meshes() const { return !meshes_.empty(); }
  double take_visits() { return meshes_.take_visits(); }
  /// before: of the frame before; empty: nothing is known of it. misplaced: likewise, of meshes;
  /// start: whether it is to be found anew.
  void begin(std::span<const TravellingBody> bodies, double h, int substeps, bool stands,
             std::span<const std::uint16_t> before, ContactStart start, const Misplaced& misplaced,
             const ContactMemory* contacts);
  /// Advances by a substep, whose flights are predicted. part: of h, by the scheme.
  void advance(const simd::Flight& flight, const float* base, double part,
               ContactParticles& particles, Team& team);
  /// Before the next substep, or after the last: verifies contacts with meshes where their interval
  /// is over. Returns whether particles had to be moved.
  bool end_interval(ContactParticles& particles, Team& team) {
    return meshes_.end_interval(particles, clock_, team);
  }
  /// After a sweep; v settles by `rate`.
  void hold(const simd::Flight& flight, const float* base, float rate, Team& team);
  /// Finds what may touch, where positions are put right and bodies stand.
  void find_standing(ContactParticles& particles, Team& team);
  /// After that, by meshes. moved(slot): as in report.
  template <class Moved>
  void hold_by_meshes(ContactParticles& particles, Team& team, Moved&& moved);
  void hold_by_meshes(std::uint32_t slot, ContactParticles& particles) {
    meshes_.solve_at(particles, clock_, slot);
  }
  /// As ContactParticles::momentum_share().
  double momentum_share() const { return momentum_share_; }
  const SurfaceContacts& meshes() const { return meshes_; }
  void remember(ContactMemory& memory) { meshes_.remember(memory); }
  void end_substep(ContactParticles& particles, Team& team) {
    meshes_.end_substep(particles, team);
  }
  /// Whether a body of a closed form may touch it in this substep.
  bool is_beside(std::uint32_t slot, kernels::Vector start, kernels::Vector x) const {
    return clear_of(slot, start, x) < meshes_.largest_thickness();
  }
  /// m, by which one particle, and its start, may be moved before it can touch one.
  double clear_of(std::uint32_t slot, kernels::Vector start, kernels::Vector x) const;
  /// Holds one particle. Returns the surface that it touches, the last of several, if there is one.
  TouchedSurface hold(std::uint32_t slot, ContactParticle& particle);
  /// The same of one that contacts within the cloth have moved (reference::follow).
  TouchedSurface follow(std::uint32_t slot, ContactParticle& particle);
  /// A particle that began there is moved by `by`, without speed: no deeper into bodies.
  kernels::Vector kept_out(std::uint32_t slot, kernels::Vector start, kernels::Vector by) const;
  /// After that: whether it did not in this substep before, and not when the last one ended.
  bool begins_to_touch(std::uint32_t slot);
  /// Whether it has touched one in this substep.
  bool touches(std::uint32_t slot) const {
    const std::uint32_t place = layout_.place_of[slot];
    return place != kNoIndex && (on_[place / kernels::kLanes] >> place % kernels::kLanes & 1) != 0;
  }
  /// The surface, of several bodies the first one's, that a particle at x touches.
  TouchedSurface touched_by(std::uint32_t slot, kernels::Vector x) const;
  void load_of_mesh(const TouchedSurface& surface, kernels::Vector x, kernels::Vector impulse) {
    meshes_.load(surface, clock_, x, impulse);
  }
  /// The surface and the normal of the nearest body of a closed form beside the particle.
  std::pair<TouchedSurface, kernels::Vector> nearest_surface(std::uint32_t slot,
                                                             kernels::Vector x) const;
  /// arrived(slot): it touches a body, and did not when the last substep ended. moved(slot):
  /// it was moved as far as a constraint of its own may be in error. quick(slot): it is to be held
  /// by itself.
  template <class Arrived, class Moved, class Quick>
  void report(Arrived&& arrived, Moved&& moved, Quick&& quick) const;
  /// impulse: as add_arrival (body_touches.h) has it.
  void arrive(const TouchedSurface& surface, kernels::Vector x, kernels::Vector v,
              kernels::Vector impulse);
  const Touching& touching() const { return on_; }

  /// m, by which a particle is under a surface where the last substep ended: any particle, for what
  /// put the cloth right may have moved it farther than the last search expected.
  double deepest(const simd::Flight& flight, const float* base, ContactParticles& particles,
                 Team& team);
  /// Adds the effects of the frame.
  void sum(BodyReport& report);
  void read_contacts(const ContactParticles& particles, std::vector<BodyTouch>& contacts) const;
  std::size_t bytes() const;

 private:
  /// Where the particles of a block are, and where they are going in an interval.
  struct Extent {
    kernels::Vector low{}, high{};
    double reach = 0;  // m, beyond
    double way = 0;    // m, the longest that is predicted

    kernels::Vector middle() const { return 0.5 * (low + high); }
    double radius() const { return 0.5 * length(high - low) + reach; }
    bool meets(const BodyClock::Box& box) const {
      return low.x - reach <= box.high.x && high.x + reach >= box.low.x &&
             low.y - reach <= box.high.y && high.y + reach >= box.low.y &&
             low.z - reach <= box.high.z && high.z + reach >= box.low.z;
    }
  };
  template <class Visit>
  void for_each_contact(Visit&& visit) const;
  void make_room();
  void search(const simd::Flight& flight, const float* base);
  /// In so many substeps from where the present one begins.
  Extent extent_of(std::size_t block, int substeps, const simd::Flight& flight,
                   const float* base) const;
  /// Whether particles of such a block may touch the body, which is in the box, in that time (s).
  bool may_touch(const Extent& extent, std::size_t body, const BodyClock::Box& box,
                 double time) const;
  void share_room(ContactParticles& particles);
  void share_among_forms(ContactParticles& particles, const Touching& touching, SubstepMoment when);
  /// m, of its distance from each particle of the block: what there is to share when the substep
  /// ends. Beside a mesh that is not known, and is what there was when it began.
  std::array<float, kernels::kLanes> spared_by(std::size_t block, std::uint32_t body) const;
  /// Adds the sums of contacts to impulses_.
  void collect_impulses();
  template <class SolveBy, class Look>
  TouchedSurface solve_with(std::uint32_t slot, ContactParticle& particle, SolveBy&& solve_by,
                            Look&& look);
  void write_frames();
  simd::BodySolve solve_data_of(const simd::Flight& flight, const float* base, float rate) const;

  const Model& model_;
  const double far_;                // of a constraint's length
  const double contact_tolerance_;  // m
  const simd::Table& table_;
  BodyClock clock_;
  ThicknessShares shares_;       // beside meshes
  ThicknessShares among_forms_;  // of bodies of a closed form among themselves
  SurfaceContacts meshes_;
  BodyLayout layout_;  // made when the first body is there
  double h_ = 0;
  double momentum_share_ = 1;
  kernels::Vector origin_{};  // of frames

  std::vector<simd::BodyFrame> frames_;    // per body
  std::vector<simd::BodyFace> faces_;      // of all of them
  std::vector<simd::BodyPair> pairs_;      // by blocks, then by bodies
  std::vector<std::uint32_t> first_pair_;  // per block that has some, and the end
  std::vector<std::uint32_t> pairs_of_;    // per block: where its pairs begin; and the end
  kernels::AlignedVector<simd::BodyContactSums> contact_sums_;  // per pair
  std::vector<std::uint16_t> touching_, moved_, quick_;         // per pair
  Touching on_, before_;               // per block, in this substep and the last
  Touching held_, arrived_;            // by the last sweep
  ContactImpulses impulses_;           // before the last search, and of arrivals; but for meshes
  std::vector<BodyClock::Box> boxes_;  // scratch
  std::vector<Extent> extents_;        // likewise
  std::vector<std::uint16_t> now_;     // likewise
  std::vector<BodyClearance> clearances_;  // likewise
};

template <class Arrived, class Moved, class Quick>
void SimdBodies::report(Arrived&& arrived, Moved&& moved, Quick&& quick) const {
  const auto for_each = [&](std::size_t block, std::uint32_t bits, auto&& work) {
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      work(layout_.slot_at[block * kernels::kLanes + lane]);
    }
  };
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for_each(pairs_[i].block, moved_[i], moved);
    for_each(pairs_[i].block, quick_[i], quick);
  }
  for (std::size_t active = 0; active + 1 < first_pair_.size(); ++active) {
    const std::uint32_t block = pairs_[first_pair_[active]].block;
    for_each(block, arrived_[block], arrived);
  }
}

/// visit(slot, body of the clock, m by which the last substep pushed it)
template <class Visit>
void SimdBodies::for_each_contact(Visit&& visit) const {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (std::uint32_t bits = touching_[i]; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      visit(layout_.slot_at[pairs_[i].block * kernels::kLanes + lane], std::size_t{pairs_[i].body},
            static_cast<double>(contact_sums_[i].pushed[lane]));
    }
  }
}

template <class Moved>
void SimdBodies::hold_by_meshes(ContactParticles& particles, Team& team, Moved&& moved) {
  meshes_.sweep(particles, clock_, team, [&](std::uint32_t slot, double by) {
    const std::uint32_t place = layout_.place_of[slot];
    if (place == kNoIndex) return;
    const float far = layout_.blocks[place / kernels::kLanes].far[place % kernels::kLanes];
    if (by * by > static_cast<double>(far)) moved(slot);
  });
}

}  // namespace weft
