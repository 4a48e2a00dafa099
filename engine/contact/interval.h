/// Contacts of surfaces of triangles: of a cloth with bodies that are meshes, and with itself where
/// it has self-contact. The clock of the bodies counts intervals of some substeps
/// (tuning::kContactInterval), with or without bodies. An interval has these stages:
///
///   1  points: the places of all points, and the boxes in which they are expected to stay
///   2  candidates: pairs of features that may meet at all
///   3  near: candidates that may touch; tangles: particles that come out
///      in each substep:
///   4  points: the places of the bodies' vertices in near pairs
///      narrow_gaps: how bodies share a gap smaller than their thicknesses
///      contacts: normals of the cloth beside itself are frozen, and multipliers act again
///   5  respond: lanes find near pairs with bodies that touch
///   6  respond: these are pushed apart, along their present normals, with friction
///      contacts: rounds of visits to pairs of the cloth with itself
///      when the interval is over:
///   7  verify: pairs that came near unexpectedly, and pairs that went through each other
///   8  rescue: these are stopped
///   9  tangles: pairs that could not be stopped, or crossed from the beginning
///
/// While positions are projected an interval lasts until a particle leaves its box, and has the
/// stages 7 to 9 for the cloth with itself.
///
/// Particles inside a one-sided body when it appears, or when positions are written, are remembered
/// until they are out. So are triangles that cross a body, and pairs of triangles of the cloth that
/// cross each other.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/contact/contacts.h"
#include "engine/contact/narrow_gaps.h"
#include "engine/contact/rescue.h"
#include "engine/contact/respond.h"
#include "engine/contact/touch.h"
#include "engine/contact/untangling.h"

namespace weft {

/// known: tangles are as the frame before left them. anew: positions were given, or a body was, and
/// they are looked for. goes_on: where the last frame ended, and bodies still stand as they did in
/// it: tangles with bodies are looked for, since projected positions are not verified
/// beside these.
enum class ContactStart : std::uint8_t { known, anew, goes_on };

class SurfaceContacts {
 public:
  SurfaceContacts(const Model& model, const simd::Table& table, ThicknessShares& shares)
      : model_(model),
        shares_(shares),
        points_(model),
        present_(points_),
        search_(table),
        near_search_(table),
        response_(table),
        contacts_(table),
        verification_(table),
        tangles_(table) {}

  bool empty() const { return points_.empty(); }
  double largest_thickness() const { return points_.largest_thickness(); }
  /// Begins a frame. memory: that of the last one for contacts within the cloth, if it counts.
  void begin(const BodyClock& clock, ContactStart start, const Misplaced& misplaced,
             const ContactMemory* memory);
  /// s, when a substep is predicted. Bodies that are fast beside the cloth are looked at more
  /// often: on their way they turn, and take cloth along. A slow one beside slow cloth is looked
  /// at seldom; but several may press cloth between them, and so may layers.
  double interval_for(const ContactParticles& particles, const BodyClock& clock);
  /// A substep is predicted, and the clock is where it begins: an interval of the clock may begin
  /// with it.
  void predict(ContactParticles& particles, const BodyClock& clock, Team& team);
  /// The clock has advanced to the end of the substep.
  void advance(ContactParticles& particles, const BodyClock& clock, Team& team);
  /// Before the next substep, or after the last.
  void end_substep(ContactParticles& particles, Team& team) {
    contacts_.end_substep(particles, team);
    untangling_.end_substep(particles);
  }
  void remember(ContactMemory& memory) { contacts_.remember(memory); }
  /// moved(slot, by): by how much (m).
  template <class Moved>
  void sweep(ContactParticles& particles, const BodyClock& clock, Team& team, Moved&& moved) {
    const ContactScene scene = this->scene(particles, clock);
    if (contacts_.empty()) return response_.sweep(scene, near_, team, moved);
    contacts_.begin_rounds(particles, team);
    for (int i = 0; i < tuning::kContactRounds; ++i) {
      response_.round(scene, near_, team, moved);
      contacts_.round(particles, team);
    }
    contacts_.end_rounds(moved);
    response_.sweep(scene, near_, team, moved);
  }
  /// The surface of a mesh that the slot touches in this substep, and its normal there.
  std::pair<TouchedSurface, kernels::Vector> touched_by(std::uint32_t slot) const {
    return response_.touched_by(points_, present_, near_, slot);
  }
  /// An impulse that a body has given there.
  void load(const TouchedSurface& surface, const BodyClock& clock, kernels::Vector x,
            kernels::Vector impulse) {
    impulses_.add(surface.body, clock.motions()[surface.body].to.centre, x, impulse,
                  surface.velocity);
  }
  /// Over what the slot has touched in this substep. Returns whether it was pushed.
  bool solve_at(ContactParticles& particles, const BodyClock& clock, std::uint32_t slot) {
    const bool is_pushed = contacts_.solve_at(particles, slot);
    return response_.solve_at(scene(particles, clock), near_, slot) || is_pushed;
  }
  /// After a substep, which may be the last of an interval, and again if particles were moved
  /// since. Returns whether particles had to be moved.
  bool end_interval(ContactParticles& particles, const BodyClock& clock, Team& team);

  /// m, of a pair that is nearer than its thickness.
  double deepest(ContactParticles& particles, const BodyClock& clock, Team& team) {
    if (empty()) return 0;
    return std::max(late_depth_, response_.deepest(scene(particles, clock), near_, team));
  }
  /// J, by what draws tangles apart in this frame.
  double untangling_work() const { return untangling_.work(); }
  const ContactImpulses& impulses() const { return impulses_; }
  /// Left are triangles that cross, and particles inside.
  RescueReport failures() const {
    RescueReport report = failures_;
    report.left = tangles_.count();
    report.tangled = tangles_.count_within();
    report.is_tangled_anew = report.tangled > 0 && !began_tangled_;
    return report;
  }
  struct Touching {
    int bodies = 0, within_cloth = 0;
  };
  Touching count_touching() const;
  void read_touching(const ContactParticles& particles, const BodyClock& clock,
                     std::vector<BodyTouch>& touches) const;
  const Misplaced& misplaced() const { return tangles_.misplaced(); }
  /// Since this was last asked: what it took to find pairs and to push them apart, in visits of a
  /// constraint. It is counted, not measured: what is left undone depends on it.
  double take_visits() {
    return std::exchange(visits_, 0) + response_.take_visits() + contacts_.take_visits();
  }
  std::size_t bytes() const;

 private:
  ContactScene scene(ContactParticles& particles, const BodyClock& clock) {
    return {model_, clock, points_, present_, particles, impulses_, tangles_, shares_};
  }
  void begin_interval(ContactParticles& particles, const BodyClock& clock, int substeps,
                      Team& team);
  bool still_holds(const ContactParticles& particles, const BodyClock& clock) const;
  bool verify_standing(ContactParticles& particles, const BodyClock& clock, Team& team);
  bool push_late_apart(const ContactScene& scene, Team& team);
  void stop_failures(const ContactScene& scene, Team& team);
  void find_tangles(bool has_failed);
  void expect_failures(const ContactScene& scene);

  const Model& model_;
  ThicknessShares& shares_;
  ContactPoints points_;
  PresentPoints present_;
  CandidateSearch search_;
  NearSearch near_search_;
  Response response_;
  Contacts contacts_;
  NarrowGaps narrow_gaps_;
  Verification verification_;
  Candidates candidates_;
  Near near_;
  NearContacts layers_;  // scratch
  ContactImpulses impulses_;
  ImpactZones zones_;
  RescueReport failures_;
  double visits_ = 0;
  ContactStart start_ = ContactStart::known;  // of what comes next
  bool began_tangled_ = false;                // cloth, with itself, in this frame
  double late_depth_ = 0;  // m, of pairs that came near unexpectedly, when the last interval ended
  double interval_ = 0;    // s
  bool has_looked_ahead_ = false;
  Tangles tangles_;
  Untangling untangling_;
};

}  // namespace weft
