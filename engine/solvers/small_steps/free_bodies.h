/// Bodies that move by themselves, in the substeps of a frame.
///
/// A body is a particle that turns: its velocity and its angular momentum go on by the formula of
/// the particles (substep_formula.h), and so does its centre. Its rotation is that of free flight,
/// found exactly, and additions by forces and contacts go on by the formula. So a body in flight
/// keeps its momentum and its energy, and one that lies on cloth is in step with it: their impulses
/// on each other cancel in every substep.
///
/// A particle that arrives at a body goes on at first order, as at any other body. The past of the
/// body loses the momentum that the past of the particle gains. free_contacts.h has the contacts.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/bodies/free_body.h"
#include "engine/contact/touch.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/body_report.h"
#include "engine/solvers/small_steps/free_contacts.h"
#include "engine/solvers/small_steps/substep_formula.h"
#include "engine/tuning.h"

namespace weft {

/// The beginning of a frame of bodies.
struct FreeFrame {
  double dt_substep = 0, dt_of_past = 0;  // s, of substeps; of the last one of the frame before
  int substeps = 1;
  bool stands = false;    // positions are projected
  bool has_past = false;  // that of the bodies counts
  kernels::Vector gravity{};
};

/// The change of a particle's past.
struct ChangedPast {
  kernels::Vector x{};                  // m, where it is
  kernels::Vector faster{}, farther{};  // m/s, when the substep began; m, its way in it
};

class FreeBodies {
 public:
  explicit FreeBodies(const Model& model) : model_(model) {}

  bool empty() const { return bodies_.empty(); }
  bool stands() const { return frame_.stands; }
  void begin(std::span<const FreeBody> bodies, const FreeFrame& frame);
  /// To the prediction of the next substep. Particles are predicted.
  void advance(const SubstepFormula& formula);
  /// Whether it is to be looked for particles in this substep.
  bool searches() const { return substeps_to_search_ == 0; }
  /// Which particles bodies may touch until the next search. points: position(slot),
  /// position_at_start(slot)
  template <class Points>
  void search(const Points& points);
  /// After a sweep.
  void hold(FreeContactHost& host);
  /// A particle that has come to touch a body in this substep goes on at first order from there:
  /// begin(slot) returns the change of its past. next: the formula of the next substep.
  template <class Begin>
  void take_arrivals(const SubstepFormula& next, Begin&& begin);

  /// m, by which a particle is under a surface.
  template <class Points>
  double deepest(const Points& points) const;
  /// Adds the effects of the frame.
  void sum(BodyReport& report);
  template <class Points>
  void read_contacts(const Points& points, std::vector<BodyTouch>& contacts) const;
  /// J, of those that the cloth has pushed in the frame, of their motion that differs from that of
  /// a rigid body: velocity(x), spin.
  template <class Velocity>
  double kinetic(Velocity&& velocity, kernels::Vector spin) const;
  /// Makes that motion slower by the factor, and returns J, by how much the kinetic energy falls.
  template <class Velocity>
  double slow_down(Velocity&& velocity, kernels::Vector spin, double factor);
  /// J, all falls since the frame began.
  double slowed() const { return slowed_; }
  /// Where the frame has ended.
  std::span<const FreeBody> states();
  std::size_t bytes() const;

 private:
  /// Beside FreeBody and FreeBodyNow, of each body.
  struct Course {
    BodyInertia inertia;
    Rotation from{};                                       // where the substep begins
    kernels::Vector start{};                               // likewise, its centre of mass
    kernels::Vector velocity_before{}, momentum_before{};  // likewise
    kernels::Vector middle{};  // of a ball that holds the body, in its coordinates
    double reach = 0;          // m, its radius
    BodyImpulse impulse{};     // given to the cloth
    double energy = 0;         // J, when the frame began
    double work = 0;           // J, by the caller's moment
  };
  void begin_course(std::size_t body);
  void place(std::size_t body);
  void end_substep();
  double energy(std::size_t body) const;
  double kinetic(std::size_t body, kernels::Vector velocity, kernels::Vector momentum) const;
  double radius(std::uint32_t slot) const { return model_.has_spheres() ? model_.radius[slot] : 0; }
  /// m, that a body goes in a substep.
  double way_of(std::size_t body) const;
  kernels::Vector middle_of(std::size_t body) const {
    return now_[body].motion.to.placed(courses_[body].middle);
  }
  bool is_met(std::size_t body) const {
    const BodyImpulse& given = courses_[body].impulse;
    return dot(given.linear, given.linear) > 0 || dot(given.angular, given.angular) > 0;
  }
  void begin_search();
  void take_found();
  void give_back(const FreeContact& contact, const ChangedPast& changed, double share_of_past);

  const Model& model_;
  FreeFrame frame_;
  double dt_before_ = 0, share_of_momentum_ = 1;
  int substeps_left_ = 0, substeps_to_search_ = 0;
  bool is_under_way_ = false;     // a substep has begun and was not ended
  bool is_first_search_ = false;  // of the frame
  std::vector<FreeBody> bodies_;
  std::vector<FreeBodyNow> now_;
  std::vector<Course> courses_;
  std::vector<FreeContact> contacts_, found_;  // by slots, then by bodies
  std::vector<double> ways_;                   // scratch
  FreeContactSweep sweep_;
  double friction_ = 0, slowed_ = 0;  // J
};

template <class Points>
void FreeBodies::search(const Points& points) {
  begin_search();
  const double ahead = frame_.stands ? 1 : substeps_to_search_;
  double longest = 0;
  ways_.resize(model_.slots());
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (!model_.is_particle(slot)) continue;
    ways_[slot] = ahead * length(points.position(slot) - points.position_at_start(slot));
    longest = std::max(longest, ways_[slot]);
  }
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    longest = std::max(longest, ahead * way_of(body));
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (!model_.is_particle(slot)) continue;
    const kernels::Vector x = points.position(slot);
    for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
      const double reach = courses_[body].reach + radius(slot) + ways_[slot] +
                           ahead * way_of(body) + tuning::kContactReach * longest;
      const kernels::Vector d = x - middle_of(body);
      if (dot(d, d) < reach * reach) found_.push_back({.slot = slot, .body = body});
    }
  }
  take_found();
}

template <class Begin>
void FreeBodies::take_arrivals(const SubstepFormula& next, Begin&& begin) {
  if (frame_.stands) return;
  for (FreeContact& contact : contacts_) {
    if (!contact.touches || std::exchange(contact.touched_before, true)) continue;
    if (model_.inverse_mass[contact.slot] == 0) continue;
    give_back(contact, begin(contact.slot), next.share_of_past());
  }
}

template <class Points>
double FreeBodies::deepest(const Points& points) const {
  double deepest = 0;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const kernels::Vector middle = middle_of(body);
    for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
      if (!model_.is_particle(slot)) continue;
      const kernels::Vector x = points.position(slot), start = points.position_at_start(slot);
      const double reach = courses_[body].reach + radius(slot) + length(x - start) + way_of(body);
      if (dot(x - middle, x - middle) >= reach * reach) continue;
      const reference::Touch touch = touch_of_free(now_[body].motion, start, x, radius(slot));
      deepest = std::max(deepest, -touch.gap);
    }
  }
  return deepest;
}

template <class Velocity>
double FreeBodies::kinetic(Velocity&& velocity, kernels::Vector spin) const {
  double sum = 0;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (!is_met(body)) continue;
    const FreeMotion& motion = bodies_[body].motion;
    const kernels::Vector carried = courses_[body].inertia.momentum(motion.rotation, spin);
    sum += kinetic(body, motion.velocity - velocity(motion.centre), motion.momentum - carried);
  }
  return sum;
}

template <class Velocity>
double FreeBodies::slow_down(Velocity&& velocity, kernels::Vector spin, double factor) {
  double fall = 0;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (!is_met(body)) continue;
    FreeMotion& motion = bodies_[body].motion;
    const kernels::Vector u = velocity(motion.centre),
                          carried = courses_[body].inertia.momentum(motion.rotation, spin);
    fall += kinetic(body, motion.velocity, motion.momentum);
    motion.velocity = u + factor * (motion.velocity - u);
    motion.momentum = carried + factor * (motion.momentum - carried);
    fall -= kinetic(body, motion.velocity, motion.momentum);
  }
  slowed_ += fall;
  return fall;
}

template <class Points>
void FreeBodies::read_contacts(const Points& points, std::vector<BodyTouch>& contacts) const {
  for (const FreeContact& contact : contacts_) {
    if (!contact.touches) continue;
    const reference::BodyMotion& motion = now_[contact.body].motion;
    const kernels::Vector x = points.position(contact.slot);
    const reference::Gap gap = gap_of(*motion.form, 0, motion.to.from_place(x));
    const kernels::Vector normal = motion.to.turned(gap.normal);
    contacts.push_back({contact.slot, bodies_[contact.body].id,
                        model_.inverse_mass[contact.slot] * contact.push, x - gap.gap * normal,
                        normal});
  }
}

}  // namespace weft
