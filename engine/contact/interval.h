/// Contacts of a cloth with bodies that are triangle meshes: the stages of an interval, in order.
///
/// - intervals of 2 ms (tuning::kContactInterval) begin when a substep is predicted;
/// - candidates tells which pairs of features may meet in an interval at all;
/// - near tells which of them may touch;
/// - respond pushes apart, in each substep, what is nearer than the thickness, along normals
///   of that moment, lets what was deeper come out slowly, and holds by friction what Coulomb's law
///   lets it (kernels/reference/bodies.h);
/// - verify tells, when an interval is over, what went through each other;
/// - rescue stops that;
/// - tangles knows what could not be stopped, or crossed a body from the beginning.
///
/// Particles that are inside of a one-sided body when it appears, or when positions are written,
/// are known as such until they are out, and triangles that cross a body until they do no longer.
#pragma once

#include <span>
#include <vector>

#include "engine/contact/rescue.h"
#include "kernels/reference/distances.h"

namespace weft {

/// A particle that touches a mesh where the last substep ended.
struct MeshTouch {
  std::uint32_t slot = 0;
  std::size_t body = 0;  // of the clock
  double push = 0;       // m
  kernels::Vector point{}, normal{};
};

class SurfaceContacts {
 public:
  SurfaceContacts(const Model& model, const simd::Table& table)
      : model_(model),
        search_(table),
        narrow_(table),
        response_(table),
        verification_(table),
        tangles_(table) {}

  bool empty() const { return points_.meshes().empty(); }
  /// Of a frame. is_new: positions were given, or a body was: what is misplaced is looked for.
  /// Else it is as the frame before left it.
  void begin(const BodyClock& clock, bool is_new, const Misplaced& misplaced);
  /// A substep is predicted, and the clock stands where it begins: an interval begins with it if
  /// the last one is over.
  void predict(ContactParticles& particles, const BodyClock& clock, Team& team);
  /// The clock has advanced to the end of the substep.
  void advance(const BodyClock& clock);
  /// moved(slot, by): by how much (m).
  template <class Moved>
  void sweep(ContactParticles& particles, const BodyClock& clock, Team& team, Moved&& moved) {
    response_.sweep(scene(particles, clock), near_, team, moved);
  }
  /// Over what the slot has touched in this substep. Returns whether it was pushed.
  bool hold(ContactParticles& particles, const BodyClock& clock, std::uint32_t slot) {
    return response_.hold(scene(particles, clock), near_, slot);
  }
  /// Slots that have touched a mesh in this substep.
  const std::vector<std::uint32_t>& touching() const { return response_.touching(); }
  /// After a substep, which may be the last of an interval, and again if particles were moved
  /// since. Returns whether particles had to be moved.
  bool end_interval(ContactParticles& particles, const BodyClock& clock, Team& team);

  /// m, of a pair that is nearer than its thickness.
  double deepest(ContactParticles& particles, const BodyClock& clock, Team& team) {
    if (empty()) return 0;
    return std::max(late_depth_, response_.deepest(scene(particles, clock), near_, team));
  }
  const ContactImpulses& impulses() const { return impulses_; }
  /// Left are triangles that cross, and particles inside.
  RescueReport failures() const {
    RescueReport report = failures_;
    report.left = tangles_.count() + static_cast<int>(misplaced_.inside.size());
    return report;
  }
  int count_touching() const;
  void read_touching(const ContactParticles& particles, std::vector<MeshTouch>& touches) const;
  const Misplaced& misplaced() const { return misplaced_; }
  std::size_t bytes() const;

 private:
  ContactScene scene(ContactParticles& particles, const BodyClock& clock) {
    return {model_, *cloth_, clock, points_, particles, impulses_, misplaced_, tangles_};
  }
  void begin_interval(ContactParticles& particles, const BodyClock& clock, int substeps,
                      Team& team);
  bool still_holds(const ContactParticles& particles, const BodyClock& clock) const;
  double interval_for(const BodyClock& clock) const;
  void find_inside();
  void come_out();
  void expect_failures(const BodyClock& clock, ContactParticles& particles);
  void misplace(const Pair& pair);
  bool find_nearest(std::uint32_t slot, std::uint16_t mesh, Pair& pair,
                    std::array<std::uint32_t, 4>& four, reference::Nearest& found) const;

  const Model& model_;
  const TriangleSurface* cloth_ = nullptr;  // the model's, when a mesh is there
  ContactPoints points_;
  CandidateSearch search_;
  NearSearch narrow_;
  Response response_;
  Verification verification_;
  Candidates candidates_;
  Near near_;
  ContactImpulses impulses_;
  RescueReport failures_;
  bool is_new_ = false;    // it is not known yet what is misplaced
  int left_ = 0;           // substeps of the present interval
  double late_depth_ = 0;  // m, of pairs that came near unexpectedly, when the last interval ended
  double interval_ = 0;    // s
  Misplaced misplaced_;
  Tangles tangles_;
};

}  // namespace weft
