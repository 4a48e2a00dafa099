#include "engine/solvers/small_steps/free_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/public_vectors.h"

namespace weft {

using kernels::Vector;

void FreeBodies::begin(std::span<const FreeBody> bodies, const FreeFrame& frame) {
  frame_ = frame;
  substeps_left_ = frame.substeps;
  substeps_to_search_ = 0;
  dt_before_ = frame.has_past ? frame.dt_of_past : frame.dt_substep;
  friction_ = slowed_ = 0;
  is_under_way_ = false;
  is_first_search_ = true;
  bodies_.assign(bodies.begin(), bodies.end());
  now_.assign(bodies.size(), {});
  courses_.clear();
  contacts_.clear();
  for (std::size_t body = 0; body < bodies_.size(); ++body) begin_course(body);
}

/// Without a past it is taken to have been in free flight.
void FreeBodies::begin_course(std::size_t body) {
  const FreeBody& b = bodies_[body];
  const FreeMotion& motion = b.motion;
  const FreePast& past = motion.past;
  courses_.push_back({.inertia = BodyInertia(b.mass)});
  Course& course = courses_.back();
  const double h = dt_before_;
  const Vector accelerates = frame_.gravity + (1 / b.mass.mass) * b.force;
  const Vector spin = course.inertia.spin(motion.rotation, motion.momentum);
  if (frame_.has_past && past.is_known) {
    const Vector faster = motion.velocity - past.velocity, gained = motion.momentum - past.momentum;
    course.velocity_before = past.velocity_before + faster;
    course.momentum_before = past.momentum_before + gained;
    course.start = motion.centre - (past.moved + h * faster);
    const Vector turned = past.turn + h * course.inertia.spin(motion.rotation, gained);
    course.from = product(rotation_by(-1.0 * turned), motion.rotation);
  } else {
    course.velocity_before = motion.velocity - h * accelerates;
    course.momentum_before = motion.momentum - h * b.moment;
    course.start = motion.centre - h * motion.velocity + (0.5 * h * h) * accelerates;
    const Vector turned = (-0.5 * h * h) * course.inertia.spin(motion.rotation, b.moment);
    course.from = product(rotation_by(-1.0 * turned),
                          course.inertia.flight(motion.rotation, motion.momentum, -h));
  }
  const FormBounds& bounds = b.shape->bounds();
  for (const Vector corner : bounds.corners)
    course.middle = course.middle + (1 / static_cast<double>(bounds.corners.size())) * corner;
  for (const Vector corner : bounds.corners)
    course.reach = std::max(course.reach, length(corner - course.middle));
  course.reach += bounds.radius + bounds.spread * b.thickness;
  course.impulse.id = b.id;

  FreeBodyNow& now = now_[body];
  now.inverse_mass = frame_.stands ? 0 : 1 / b.mass.mass;
  now.motion = {.form = b.shape->form(),
                .velocity = frame_.stands ? Vector{} : motion.velocity,
                .spin = frame_.stands ? Vector{} : spin,
                .thickness = b.thickness,
                .friction = frame_.stands ? 0 : b.friction,
                .h = frame_.stands ? std::numeric_limits<double>::infinity() : frame_.dt_substep};
  now.dt_substep = frame_.dt_substep;
  if (!frame_.stands) now.inverse_inertia = course.inertia.turned_inverse(motion.rotation);
  if (frame_.stands) {
    course.start = motion.centre;
    course.from = motion.rotation;
  }
  place(body);
  course.energy = energy(body);
}

/// Sets out the body where its state is.
void FreeBodies::place(std::size_t body) {
  const Vector offset = to_internal(bodies_[body].mass.centre);
  const auto at = [&](const Rotation& rotation, Vector centre) {
    reference::Placement placement = placement_of(rotation, centre);
    placement.centre = centre - placement.turned(offset);
    return placement;
  };
  const FreeMotion& motion = bodies_[body].motion;
  FreeBodyNow& now = now_[body];
  now.centre = motion.centre;
  now.motion.from = at(courses_[body].from, courses_[body].start);
  now.motion.to = at(motion.rotation, motion.centre);
  if (frame_.stands) return;
  now.motion.velocity = motion.velocity;
  now.motion.spin = courses_[body].inertia.spin(motion.rotation, motion.momentum);
}

double FreeBodies::kinetic(std::size_t body, Vector velocity, Vector momentum) const {
  const FreeBody& b = bodies_[body];
  const Vector spin = courses_[body].inertia.spin(b.motion.rotation, momentum);
  return 0.5 * (b.mass.mass * dot(velocity, velocity) + dot(momentum, spin));
}

double FreeBodies::energy(std::size_t body) const {
  const FreeBody& b = bodies_[body];
  const Vector pull = b.mass.mass * frame_.gravity + b.force;
  return kinetic(body, b.motion.velocity, b.motion.momentum) - dot(pull, b.motion.centre);
}

double FreeBodies::way_of(std::size_t body) const {
  const reference::BodyMotion& motion = now_[body].motion;
  if (frame_.stands) return 0;
  return frame_.dt_substep * (length(motion.velocity) + length(motion.spin) * courses_[body].reach);
}

/// The friction of the last substep, and the work of moments in it.
void FreeBodies::end_substep() {
  if (!std::exchange(is_under_way_, false)) return;
  for (const FreeContact& contact : contacts_)
    friction_ +=
        share_of_momentum_ * length(contact.slow) * length(contact.slides) / frame_.dt_substep;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Rotation turn = product(bodies_[body].motion.rotation, inverse(courses_[body].from));
    courses_[body].work += dot(bodies_[body].moment, turn_of(turn));
  }
}

void FreeBodies::advance(const SubstepFormula& formula) {
  end_substep();
  is_under_way_ = true;
  const double h = frame_.dt_substep, bh = formula.part * h;
  share_of_momentum_ = 1 / formula.part;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const FreeBody& body = bodies_[i];
    FreeMotion& motion = bodies_[i].motion;
    Course& course = courses_[i];
    const BodyInertia& inertia = course.inertia;
    const Vector accelerates = frame_.gravity + (1 / body.mass.mass) * body.force;
    const Vector velocity = motion.velocity +
                            formula.past * (motion.velocity - course.velocity_before) +
                            bh * accelerates;
    const Vector momentum = motion.momentum +
                            formula.past * (motion.momentum - course.momentum_before) +
                            bh * body.moment;
    const Vector centre =
        motion.centre + formula.past * (motion.centre - course.start) + bh * velocity;
    const Vector turned = turn_of(product(motion.rotation, inverse(course.from)));
    const Rotation flown_from = inertia.flight(motion.rotation, motion.momentum, -dt_before_);
    const Vector flown = turn_of(product(motion.rotation, inverse(flown_from)));
    const Vector beyond = formula.past * (turned - flown) +
                          bh * inertia.spin(motion.rotation, momentum - motion.momentum);
    course.start = motion.centre;
    course.from = motion.rotation;
    course.velocity_before = motion.velocity;
    course.momentum_before = motion.momentum;
    motion.rotation = normalized(
        product(rotation_by(beyond), inertia.flight(motion.rotation, motion.momentum, h)));
    motion.centre = centre;
    motion.velocity = velocity;
    motion.momentum = momentum;
    // A force on a particle acts for the share of a substep that decay leaves.
    now_[i].inverse_mass = 1 / (formula.share * body.mass.mass);
    now_[i].inverse_inertia = inertia.turned_inverse(motion.rotation);
    for (double& each : now_[i].inverse_inertia.of) each /= formula.share;
    place(i);
  }
  dt_before_ = h;
  for (FreeContact& contact : contacts_) contact.begin_substep();
  substeps_to_search_ = std::max(0, substeps_to_search_ - 1);
  --substeps_left_;
}

void FreeBodies::begin_search() {
  const double substeps = std::max(1.0, std::floor(tuning::kContactInterval / frame_.dt_substep));
  substeps_to_search_ = static_cast<int>(std::min<double>(substeps, substeps_left_ + 1));
  found_.clear();
}

/// Contacts that were known are.
void FreeBodies::take_found() {
  const auto key = [](const FreeContact& c) { return std::pair(c.slot, c.body); };
  std::size_t old = 0;
  for (FreeContact& contact : found_) {
    while (old < contacts_.size() && key(contacts_[old]) < key(contact)) ++old;
    if (old < contacts_.size() && key(contacts_[old]) == key(contact)) contact = contacts_[old];
    if (is_first_search_)
      contact.touched_before =
          std::ranges::binary_search(bodies_[contact.body].motion.touching, contact.slot);
  }
  is_first_search_ = false;
  contacts_.swap(found_);
}

void FreeBodies::hold(FreeContactHost& host) {
  sweep_.run(contacts_, now_, host);
  if (frame_.stands) return;
  for (const FreeImpulse& given : sweep_.impulses()) {
    BodyImpulse& sum = courses_[given.body].impulse;
    const Vector impulse = share_of_momentum_ * given.impulse;
    sum.linear = sum.linear + impulse;
    sum.angular = sum.angular + cross(given.at - now_[given.body].motion.to.centre, impulse);
  }
  const bool is_mended = host.particles().is_mended();
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const FreeBodyNow& now = now_[body];
    FreeMotion& motion = bodies_[body].motion;
    Course& course = courses_[body];
    motion.centre = motion.centre + now.moved;
    motion.rotation = normalized(product(rotation_by(now.turned), motion.rotation));
    motion.velocity = motion.velocity + now.faster;
    motion.momentum = motion.momentum + now.gained;
    course.start = course.start + (is_mended ? now.moved : now.recovered);
    course.from =
        normalized(product(rotation_by(is_mended ? now.turned : now.turned_back), course.from));
    place(body);
  }
}

/// The past of a particle has changed by so much: what the two have together stays. The past of a
/// body that is lighter would change by more than either moves: it takes as much as its own mass
/// does.
void FreeBodies::give_back(const FreeContact& contact, const ChangedPast& changed,
                           double share_of_past) {
  const auto& [x, faster, farther] = changed;
  Course& course = courses_[contact.body];
  const FreeBodyNow& now = now_[contact.body];
  const double mass = std::min(model_.mass[contact.slot], bodies_[contact.body].mass.mass);
  const Vector r = x - now.centre;
  course.velocity_before = course.velocity_before - (mass * now.inverse_mass) * faster;
  course.momentum_before = course.momentum_before - cross(r, mass * faster);
  course.start = course.start + (mass * now.inverse_mass) * farther;
  course.from =
      normalized(product(rotation_by(now.inverse_inertia * cross(r, mass * farther)), course.from));
  const Vector impulse = (-share_of_past * mass) * faster;
  course.impulse.linear = course.impulse.linear + impulse;
  course.impulse.angular = course.impulse.angular + cross(x - now.motion.to.centre, impulse);
}

void FreeBodies::sum(BodyReport& report) {
  if (frame_.stands) return;
  end_substep();
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    BodyImpulse impulse = courses_[body].impulse;
    impulse.centre = now_[body].motion.to.centre;
    report.impulses.push_back(impulse);
    report.work += courses_[body].energy + courses_[body].work - energy(body);
  }
  report.friction += friction_;
  for (const FreeContact& contact : contacts_) report.contacts += contact.touches ? 1 : 0;
}

std::span<const FreeBody> FreeBodies::states() {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    FreeMotion& motion = bodies_[body].motion;
    const Course& course = courses_[body];
    motion.past = {.is_known = true,
                   .velocity = motion.velocity,
                   .momentum = motion.momentum,
                   .velocity_before = course.velocity_before,
                   .momentum_before = course.momentum_before,
                   .moved = motion.centre - course.start,
                   .turn = turn_of(product(motion.rotation, inverse(course.from)))};
    motion.touching.clear();
  }
  for (const FreeContact& contact : contacts_) {
    if (contact.touches) bodies_[contact.body].motion.touching.push_back(contact.slot);
  }
  return bodies_;
}

std::size_t FreeBodies::bytes() const {
  return bytes_of(bodies_) + bytes_of(now_) + bytes_of(courses_) + bytes_of(contacts_) +
         bytes_of(found_) + bytes_of(ways_) + sweep_.bytes();
}

}  // namespace weft
