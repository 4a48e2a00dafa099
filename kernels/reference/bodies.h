/// A particle against a body that moves, in double: what the vector kernel (kernels/simd/bodies.h)
/// is held against, and what local passes do.
///
/// In a substep a particle goes from `start` to x, and the body from one placement to another. Both
/// ways are looked at in the coordinates of the body, so that only the particle moves, in a
/// straight line. If it ends under the surface, or has come through it, it is pushed out along the
/// normal n by what is missing of the gap, p. Friction takes of its way s along the surface what it
/// may, mu p, and of its velocity likewise: the normal velocity into the body, j, is taken, and
/// mu j of the velocity along the surface (Coulomb). So a position is moved by forces of this
/// substep alone, and no speed comes from being pushed out: a position and a velocity of a
/// particle that stays in contact obey BDF2 of the equations of motion with a multiplier each
/// (Gear, Leimkuhler and Gupta, 1985), as with anchors (anchors.h).
///
/// A particle that was deeper when the substep began comes out slowly, and without friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/reference/corner.h"
#include "kernels/reference/forms.h"
#include "kernels/vectors.h"

namespace weft::reference {

/// A rotation by the columns of its matrix, and where the origin comes to lie.
struct Placement {
  Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vector centre{};

  Vector turned(Vector v) const { return v.x * x + v.y * y + v.z * z; }
  Vector turned_back(Vector v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vector placed(Vector v) const { return centre + turned(v); }
  Vector from_place(Vector v) const { return turned_back(v - centre); }
};

/// How a body moves in a substep.
struct BodyMotion {
  const Form* form = nullptr;  // null: a mesh
  Placement from{}, to{};
  Vector velocity{}, spin{};  // m/s of its centre, rad/s
  double thickness = 0;       // m
  double friction = 0;        // with the cloth
  double h = 0;               // s

  Vector velocity_at(Vector x) const { return velocity + cross(spin, x - to.centre); }
};

/// A particle under the surface comes out at the speed kRecovery + depth / kRecoveryTime, but not
/// faster than kFastestRecovery. At 0.5 m/s one that was found late stayed deep for a frame (3 mm,
/// of a ball at 10 m/s); without a limit cloth 30 cm deep was thrown out at 100 m/s.
inline constexpr double kRecovery = 0.05, kFastestRecovery = 2;  // m/s
inline constexpr double kRecoveryTime = 3e-3;                    // s

inline Gap gap_of(const Form& form, double thickness, Vector y) {
  Gap gap = form.gap(y);
  gap.gap -= thickness;
  return gap;
}

/// Where a particle of a radius touches the body that goes from start to x.
inline Touch find_touch(const BodyMotion& body, Vector start, Vector x, double radius) {
  const Vector y0 = body.from.from_place(start), y1 = body.to.from_place(x);
  Touch touch = body.form->touch(body.thickness + radius, y0, y1);
  touch.normal = body.to.turned(touch.normal);
  return touch;
}

/// Finds the gap of one that is not under the surface, too.
inline Touch find_touch_or_gap(const BodyMotion& body, Vector start, Vector x, double radius) {
  Touch touch = find_touch(body, start, x, radius);
  if (touch.is_near) return touch;
  const Gap gap = gap_of(*body.form, body.thickness + radius, body.to.from_place(x));
  return {true, body.to.turned(gap.normal), gap.gap};
}

/// m, by which a particle is under the surface where it ends; not positive: it is not.
inline double depth_of(const BodyMotion& body, Vector start, Vector x, double radius) {
  const Touch touch = find_touch(body, start, x, radius);
  if (!touch.is_near) return 0;
  if (body.form->is_convex()) return -touch.gap;
  const Gap end = gap_of(*body.form, body.thickness + radius, body.to.from_place(x));
  return -std::min(touch.gap, end.gap);
}

/// m, by which both ends of a way may be moved beside the body that the particle touches nothing.
/// Where it is not positive the particle may touch.
inline double clear_of(const BodyMotion& body, Vector start, Vector x, double radius) {
  const Vector y0 = body.from.from_place(start), y1 = body.to.from_place(x);
  return body.form->clear(body.thickness + radius, y0, y1);
}

/// The way of the particle beside the material of the body that was where it began.
inline Vector slip_of(const BodyMotion& body, Vector start, Vector x) {
  return x - body.to.placed(body.from.from_place(start));
}

/// The rest of a way by which the start of a substep is moved: it leads no deeper into the
/// body.
inline Vector kept_out(const BodyMotion& body, Vector start, Vector by, double radius) {
  const double thickness = body.thickness + radius;
  const Gap to = gap_of(*body.form, thickness, body.from.from_place(start + by));
  if (to.gap >= 0) return by;
  const Gap from = gap_of(*body.form, thickness, body.from.from_place(start));
  return by + std::max(0.0, std::min(0.0, from.gap) - to.gap) * body.from.turned(to.normal);
}

inline constexpr double kPressed = 1e6;  // over a thinning: more than any pull

/// By how much a body is treated as thinner where the gap to another one is narrow
/// (engine/contact/thickness_shares.h). m: at the end of the substep, and the part that is new
/// since both bodies close on each other.
struct Thinning {
  double by = 0, retreat = 0;

  /// m, by which the other body presses for the sake of friction: any friction holds cloth that is
  /// clamped between two solid bodies.
  double presses() const { return kPressed * by; }
};

/// The effect of contacts of a particle and a body in a substep.
struct ContactSums {
  double pushed = 0, held = 0;     // m: along the normal, without what came out, and by friction
  double stopped = 0, slowed = 0;  // m/s, likewise
  double came_out = 0;             // m, along the normal: the rest of the pushes
  Thinning thinning{};
};

/// How a point of the cloth and the surface under it have come together in a substep.
struct PointContact {
  Vector normal{};    // out of the body
  double gap = 0;     // m, at the end; negative: under the surface
  Vector slip{};      // m, of the point beside the material of the body
  double forces = 1;  // on all sides of a corner, over that along the normal
};

struct ContactResult {
  bool is_touching = false;
  Vector start{};       // where the substep began, moved by what came out: no speed is gained by it
  Vector x{}, v{};      // where it is, and its velocity there
  Vector normal{};      // of the surface
  double push = 0;      // m
  double friction = 0;  // (m/s)^2, twice the energy that friction took, per mass
};

/// Shortens `along` by what friction may still hold. Returns the share that is taken.
inline double held_share(double along, double may, double& held) {
  const double left = std::max(0.0, may - held);
  const double share = along > left ? left / along : 1;
  held += share * along;
  return share;
}

/// A push out of a surface.
struct Push {
  double push = 0;       // m, along the normal; 0: nothing touches
  double comes_out = 0;  // m of it, that were deeper when the substep began
};
inline Push push_out(const PointContact& e, double toward, double h, ContactSums& done) {
  const double gap = e.gap + done.thinning.by;
  const double approach = toward - done.thinning.retreat, began = gap + approach - done.came_out;
  const double recovers = h * std::min(kFastestRecovery, kRecovery - began / kRecoveryTime);
  const double target = std::min(0.0, began < 0 ? began + recovers : 0.0);
  const double push = target - gap;
  if (!(push > 0)) return {};
  const double stays_out = std::min(push, std::max(0.0, approach));
  done.pushed += e.forces * stays_out;
  done.came_out += push - stays_out;
  return {push, push - stays_out};
}

/// A way along the surface, of which friction takes a part.
struct Rubbed {
  double slid = 0;  // m, that friction has left
  Vector by{};      // m, of the point
};
inline Rubbed rub(Vector along, double friction, ContactSums& done) {
  const double l = length(along);
  const double held = held_share(l, friction * (done.pushed + done.thinning.presses()), done.held);
  return {(1 - held) * l, -held * along};
}

/// The correction of a position by a contact.
struct Stop {
  double push = 0, comes_out = 0;  // of Push
  double slid = 0;                 // of Rubbed
  Vector by{};                     // m, of the point, altogether
};
inline Stop stop(const PointContact& e, double friction, double h, ContactSums& done) {
  const double toward = -dot(e.normal, e.slip);
  const Push out = push_out(e, toward, h, done);
  if (!(out.push > 0)) return {};
  const Rubbed rubbed = rub(e.slip + toward * e.normal, friction, done);
  return {out.push, out.comes_out, rubbed.slid, out.push * e.normal + rubbed.by};
}

/// The correction of the velocity of the point relative to the surface.
struct Slowed {
  Vector change{};   // m/s
  double taken = 0;  // m/s, along the surface
};
inline Slowed slow_along(Vector sliding, double friction, double h, ContactSums& done) {
  const double l = length(sliding);
  const double may = friction * (done.stopped + done.thinning.presses() / h);
  const double slowed = held_share(l, may, done.slowed);
  return {-slowed * sliding, slowed * l};
}
/// The velocity into the surface, which is stopped. forces: of PointContact.
inline double stop_velocity(double into, double forces, double h, ContactSums& done) {
  const double stopped = std::max(0.0, into - done.thinning.retreat / h);
  done.stopped += forces * stopped;
  return stopped;
}
inline Slowed slow(Vector normal, Vector relative, double friction, double h, ContactSums& done) {
  const double into = stop_velocity(-dot(normal, relative), 1, h, done);
  const Vector sliding = relative - dot(normal, relative) * normal;
  const Slowed slowed = slow_along(sliding, friction, h, done);
  return {into * normal + slowed.change, slowed.taken};
}

/// By one surface: of a convex form.
inline ContactResult solve_one_side(const BodyMotion& body, const Touch& touch, Vector start,
                                    Vector x, Vector v, ContactSums& done) {
  ContactResult result{.start = start, .x = x, .v = v};
  if (!touch.is_near) return result;
  const Vector n = touch.normal;
  const Stop stopped = stop({n, touch.gap, slip_of(body, start, x)}, body.friction, body.h, done);
  if (!(stopped.push > 0)) return result;
  result.is_touching = true;
  result.normal = n;
  result.push = stopped.push;
  result.start = start + stopped.comes_out * n;
  result.x = x + stopped.by;
  const Slowed slowed = slow(n, v - body.velocity_at(result.x), body.friction, body.h, done);
  result.v = v + slowed.change;
  result.friction = 2 * slowed.taken * (stopped.slid / body.h);
  return result;
}

/// Pushes the particle out of one side of a hollow after the other. Returns how many pushed.
inline int push_out_of_sides(const BodyMotion& body, Touch touch, double radius, ContactSums& done,
                             Corner& corner, ContactResult& result) {
  int sides = 0;
  for (; sides < Corner::kSides && touch.is_near; ++sides) {
    const auto [n, sine, forces] = corner.add(touch.normal);
    const Vector slip = slip_of(body, result.start, result.x);
    const Push out = push_out({n, touch.gap / sine, slip, forces}, -dot(n, slip), body.h, done);
    if (!(out.push > 0)) break;
    result.normal = n;
    result.push += out.push;
    result.start = result.start + out.comes_out * n;
    result.x = result.x + out.push * n;
    const double into = -dot(n, result.v - body.velocity_at(result.x));
    result.v = result.v + stop_velocity(into, forces, body.h, done) * n;
    touch = find_touch(body, result.start, result.x, radius);
  }
  return sides;
}

/// By the sides of a hollow, and then by the friction of all of them.
inline ContactResult solve_sides(const BodyMotion& body, const Touch& touch, Vector start, Vector x,
                                 Vector v, double radius, ContactSums& done) {
  ContactResult result{.start = start, .x = x, .v = v};
  Corner corner;
  const int sides = push_out_of_sides(body, touch, radius, done, corner, result);
  result.is_touching = sides > 0;
  if (!result.is_touching) return result;
  const Rubbed rubbed =
      rub(corner.free_part(slip_of(body, result.start, result.x)), body.friction, done);
  result.x = result.x + rubbed.by;
  const Vector sliding = corner.free_part(result.v - body.velocity_at(result.x));
  const Slowed slowed = slow_along(sliding, body.friction, body.h, done);
  result.v = result.v + slowed.change;
  result.friction = 2 * slowed.taken * (rubbed.slid / body.h);
  if (sides == 1) return result;
  // Friction may take it back into a side that it was pushed away from.
  const Touch again = find_touch(body, result.start, result.x, radius);
  push_out_of_sides(body, again, radius, done, corner, result);
  return result;
}

/// v: the velocity at x. touch: of that way.
inline ContactResult solve_contact(const BodyMotion& body, const Touch& touch, Vector start,
                                   Vector x, Vector v, double radius, ContactSums& done) {
  return body.form->is_convex() ? solve_one_side(body, touch, start, x, v, done)
                                : solve_sides(body, touch, start, x, v, radius, done);
}

/// A particle that contacts within the cloth have moved in rounds. Its contact is solved if it came
/// under the surface. Otherwise it follows the body as far as that has pushed too much. touch: its
/// gap and normal may be those of a particle over the surface.
inline ContactResult follow(const BodyMotion& body, const Touch& touch, Vector start, Vector x,
                            Vector v, double radius, ContactSums& done) {
  ContactResult result = solve_contact(body, touch, start, x, v, radius, done);
  if (result.is_touching) return result;
  const double back = std::min(touch.gap + done.thinning.by, done.pushed);
  if (!(back > 0)) return result;
  const double apart = dot(touch.normal, v - body.velocity_at(x)),
               faster = std::clamp(apart, 0.0, done.stopped);
  done.pushed -= back;
  done.stopped -= faster;
  result.is_touching = true;
  result.normal = touch.normal;
  result.push = -back;
  result.x = x - back * touch.normal;
  result.v = v - faster * touch.normal;
  return result;
}

}  // namespace weft::reference
