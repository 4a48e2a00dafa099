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
#include <cstddef>
#include <limits>
#include <span>

#include "kernels/vectors.h"

namespace weft::reference {

using kernels::Vector;

/// A rotation by the columns of its matrix, and where the origin comes to lie.
struct Placement {
  Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vector centre{};

  Vector turned(Vector v) const { return v.x * x + v.y * y + v.z * z; }
  Vector turned_back(Vector v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vector placed(Vector v) const { return centre + turned(v); }
  Vector from_place(Vector v) const { return turned_back(v - centre); }
};

/// Points with normal . x < offset are inside.
struct Face {
  Vector normal{};
  double offset = 0;
};

/// Either the inside of faces, or the balls around a segment, in coordinates of the body.
struct Solid {
  std::span<const Face> faces{};  // empty: a capsule
  Vector a{}, axis{};             // where it begins, and the unit vector along it
  double length = 0;              // m; 0: a ball
  double radius = 0;              // m, at a
  double taper = 0;               // by which the radius falls, per length; |taper| < 1
};

/// How a body moves in a substep.
struct BodyMotion {
  Solid solid{};
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

/// The surface where a particle touches it, in coordinates of the world.
struct Touch {
  bool is_near = false;  // it is under the surface, or came through it
  Vector normal{};
  double gap = 0;  // m, over the surface's plane there; negative: under it
};

struct Gap {
  double gap = std::numeric_limits<double>::infinity();
  Vector normal{};
};

/// The ball of the capsule that is nearest to y is at the height y_axis - k d / sqrt(1 - k^2) over
/// a, with k the taper and d the distance from the axis.
inline Gap gap_of_capsule(const Solid& s, double thickness, Vector y) {
  const Vector from_a = y - s.a;
  const double height = dot(from_a, s.axis);
  const double across = std::sqrt(std::max(0.0, dot(from_a, from_a) - height * height));
  const double lean = s.taper / std::sqrt(1 - s.taper * s.taper);
  const double at = std::clamp(height - lean * across, 0.0, s.length);
  const Vector d = from_a - at * s.axis;
  const double l = length(d);
  return {l - (s.radius - at * s.taper) - thickness, kernels::direction(d, l)};
}

inline Gap gap_of_faces(const Solid& s, double thickness, Vector y) {
  Gap largest{-std::numeric_limits<double>::infinity(), {}};
  for (const Face& face : s.faces) {
    const double gap = dot(face.normal, y) - face.offset - thickness;
    if (gap > largest.gap) largest = {gap, face.normal};
  }
  return largest;
}

inline Gap gap_of(const Solid& s, double thickness, Vector y) {
  return s.faces.empty() ? gap_of_capsule(s, thickness, y) : gap_of_faces(s, thickness, y);
}

/// The face through which the way from y0 to y1 enters the inside of all. For a way that begins
/// there it is the face nearest to its beginning, where the way leads down from that or ends
/// inside: a particle on a thin body, by rounding inside, does not leave it by the other side.
inline Touch touch_faces(const Solid& s, double thickness, Vector y0, Vector y1) {
  double enters = -1, leaves = std::numeric_limits<double>::infinity();
  const Face* entry = nullptr;
  Touch inside{.gap = 0};
  double nearest = -std::numeric_limits<double>::infinity();
  bool ends_inside = true;
  for (const Face& face : s.faces) {
    const double g0 = dot(face.normal, y0) - face.offset - thickness;
    const double g1 = dot(face.normal, y1) - face.offset - thickness;
    if (g0 > 0 && g1 > 0) return {};
    ends_inside = ends_inside && g1 <= 0;
    if (g0 > nearest) {
      nearest = g0;
      inside = {true, face.normal, g1};
    }
    if (g0 <= 0 && g1 <= 0) continue;
    const double at = g0 / (g0 - g1);
    if (g1 > 0) {
      leaves = std::min(leaves, at);
    } else if (at > enters) {
      enters = at;
      entry = &face;
    }
  }
  if (entry == nullptr) return ends_inside || inside.gap < nearest ? inside : Touch{};
  if (enters > leaves) return {};
  return {true, entry->normal, dot(entry->normal, y1) - entry->offset - thickness};
}

/// On a way as long as a quarter of the thickness of the capsule the first point under the surface
/// is looked for: a step by the gap never goes too far. On shorter ways, and on those that begin
/// under the surface and lead out, the end is looked at.
inline Touch touch_capsule(const Solid& s, double thickness, Vector y0, Vector y1) {
  const Gap end = gap_of_capsule(s, thickness, y1);
  const Vector way = y1 - y0;
  const double l = length(way);
  const double thin = std::min(s.radius, s.radius - s.taper * s.length) + thickness;
  if (4 * l <= thin) return {end.gap < 0, end.normal, end.gap};
  Gap here = gap_of_capsule(s, thickness, y0);
  if (here.gap < 0 && dot(here.normal, way) >= 0) return {end.gap < 0, end.normal, end.gap};
  const double near = 1e-6 * thin;
  double at = 0;
  for (int i = 0; i < 64 && here.gap > near; ++i) {
    at += here.gap / l;
    if (at >= 1) return {end.gap < 0, end.normal, end.gap};
    here = gap_of_capsule(s, thickness, y0 + at * way);
  }
  const double gap = here.gap + (1 - at) * dot(here.normal, way);
  return {gap < 0, here.normal, gap};
}

/// Where a particle of a radius touches the body that goes from start to x.
inline Touch find_touch(const BodyMotion& body, Vector start, Vector x, double radius) {
  const Vector y0 = body.from.from_place(start), y1 = body.to.from_place(x);
  const double thickness = body.thickness + radius;
  Touch touch = body.solid.faces.empty() ? touch_capsule(body.solid, thickness, y0, y1)
                                         : touch_faces(body.solid, thickness, y0, y1);
  touch.normal = body.to.turned(touch.normal);
  return touch;
}

/// Finds the gap of one that is not under the surface, too.
inline Touch find_touch_or_gap(const BodyMotion& body, Vector start, Vector x, double radius) {
  Touch touch = find_touch(body, start, x, radius);
  if (touch.is_near) return touch;
  const Gap gap = gap_of(body.solid, body.thickness + radius, body.to.from_place(x));
  return {true, body.to.turned(gap.normal), gap.gap};
}

/// m, by which both ends of a way may be moved beside the body that the particle touches nothing:
/// both are in front of one face by that, or the longest way that comes of it does not reach the
/// capsule. Where it is not positive the particle may touch.
inline double clear_of(const BodyMotion& body, Vector start, Vector x, double radius) {
  const Vector y0 = body.from.from_place(start), y1 = body.to.from_place(x);
  const double thickness = body.thickness + radius;
  if (body.solid.faces.empty())
    return (gap_of_capsule(body.solid, thickness, y1).gap - length(y1 - y0)) / 3;
  double clear = -std::numeric_limits<double>::infinity();
  for (const Face& face : body.solid.faces) {
    const double nearer = std::min(dot(face.normal, y0), dot(face.normal, y1));
    clear = std::max(clear, nearer - face.offset - thickness);
  }
  return clear;
}

/// The way of the particle beside the material of the body that was where it began.
inline Vector slip_of(const BodyMotion& body, Vector start, Vector x) {
  return x - body.to.placed(body.from.from_place(start));
}

/// The rest of a way by which the start of a substep is moved: it leads no deeper into the
/// body.
inline Vector kept_out(const BodyMotion& body, Vector start, Vector by, double radius) {
  const double thickness = body.thickness + radius;
  const Gap to = gap_of(body.solid, thickness, body.from.from_place(start + by));
  if (to.gap >= 0) return by;
  const Gap from = gap_of(body.solid, thickness, body.from.from_place(start));
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
  Vector normal{};  // out of the body
  double gap = 0;   // m, at the end; negative: under the surface
  Vector slip{};    // m, of the point beside the material of the body
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

/// The correction of a position by a contact.
struct Stop {
  double push = 0;       // m, along the normal; 0: nothing touches
  double comes_out = 0;  // m of it, that were deeper when the substep began
  double slid = 0;       // m, along the surface, that friction has left
  Vector by{};           // m, of the point, altogether
};
inline Stop stop(const PointContact& e, double friction, double h, ContactSums& done) {
  const double toward = -dot(e.normal, e.slip), gap = e.gap + done.thinning.by;
  const double approach = toward - done.thinning.retreat, began = gap + approach - done.came_out;
  const double recovers = h * std::min(kFastestRecovery, kRecovery - began / kRecoveryTime);
  const double target = std::min(0.0, began < 0 ? began + recovers : 0.0);
  const double push = target - gap;
  if (!(push > 0)) return {};
  const double stays_out = std::min(push, std::max(0.0, approach));
  done.pushed += stays_out;
  done.came_out += push - stays_out;
  const Vector along = e.slip + toward * e.normal;
  const double l = length(along);
  const double held = held_share(l, friction * (done.pushed + done.thinning.presses()), done.held);
  return {push, push - stays_out, (1 - held) * l, push * e.normal - held * along};
}

/// The correction of the velocity of the point relative to the surface.
struct Slowed {
  Vector change{};   // m/s
  double taken = 0;  // m/s, along the surface
};
inline Slowed slow(Vector normal, Vector relative, double friction, double h, ContactSums& done) {
  const double into = std::max(0.0, -dot(normal, relative) - done.thinning.retreat / h);
  done.stopped += into;
  const Vector sliding = relative - dot(normal, relative) * normal;
  const double l = length(sliding);
  const double may = friction * (done.stopped + done.thinning.presses() / h);
  const double slowed = held_share(l, may, done.slowed);
  return {into * normal - slowed * sliding, slowed * l};
}

/// v: the velocity at x. touch: of that way.
inline ContactResult solve_contact(const BodyMotion& body, const Touch& touch, Vector start,
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

/// A particle that contacts within the cloth have moved in rounds. Its contact is solved if it came
/// under the surface. Otherwise it follows the body as far as that has pushed too much. touch: its
/// gap and normal may be those of a particle over the surface.
inline ContactResult follow(const BodyMotion& body, const Touch& touch, Vector start, Vector x,
                            Vector v, ContactSums& done) {
  ContactResult result = solve_contact(body, touch, start, x, v, done);
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
