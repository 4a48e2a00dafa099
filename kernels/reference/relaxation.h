/// The problem that every impulse loop of the reference solves, and the visit of one constraint.
///
/// Unknowns x: predicted positions (position loop) or velocities (velocity loop). Constraint c
/// joins the particles a and b along the unit direction n = (p_a - p_b) / |p_a - p_b|. Its error is
///
///     e = n . (x_a - x_b) - target            (paper 4.1; target = rest length, r1 + r2, or 0)
///
/// and the impulse lambda that removes it, with w = 1/m (paper 3.2, 3.3; in the position loop
/// lambda is an impulse times h, a mass times a length):
///
///     lambda = e / (w_a + w_b);   x_a -= w_a lambda n;   x_b += w_b lambda n
///
/// (The paper prints this magnitude as p' and then adds p' n to the positions; w is missing there.)
///
/// Unilateral constraints bound the accumulated impulse, not each change of it: an early over-push
/// must be able to be taken back. With lambda > 0 shortening: ropes keep lambda >= 0, contacts
/// keep lambda <= 0.
///
/// A spring gives way by softness = compliance / h^2 times the impulse that it has accumulated, mu
/// (mu / h^2 is its tension), so that
///
///     e = n . (x_a - x_b) - target - softness mu,     lambda = e / (w_a + w_b + softness)
///
/// Constraints stand in four ranges, so that the common kind is solved without a question asked:
///
///   [0, plain)            distance, no hub at either end, colour by colour
///   [plain, bilateral)    distance, a hub at one end or both
///   [bilateral, pulling)  ropes
///   [pulling, count)      contacts; a is the sphere
///
/// Scheme rattle: n is taken at the positions `start` of the step's beginning, while errors are
/// true ones, at x. Renewing then sets the target so that both hold:
///
///     target = n . (x_a - x_b) - (|x_a - x_b| - rest length)
///
/// Contacts come about within the step: they always act along their directions at x.
///
/// A hub is a particle of so many constraints (kHubDegree, or any sphere) that telling every
/// neighbour of a change costs more than every neighbour asking for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/loop.h"
#include "kernels/vectors.h"

namespace weft::reference {

using kernels::Directions;
using kernels::LoopResult;
using kernels::Sweep;
using kernels::Vector;
using kernels::VectorsView;

inline constexpr std::size_t kHubDegree = 16;
inline constexpr std::size_t kBlock = 32;  // most plain constraints of one colour in a block
inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// A flag of one byte that, unlike std::uint8_t, cannot alias the pointers around it.
enum class Flag : std::uint8_t { clear, set };
inline bool is_set(Flag flag) { return flag == Flag::set; }

struct Relaxation {
  std::size_t particles = 0;
  std::size_t plain = 0, bilateral = 0, pulling = 0, count = 0;

  const std::uint32_t* a = nullptr;
  const std::uint32_t* b = nullptr;
  const double* target = nullptr;
  const double* tolerance = nullptr;       // |e| up to here is satisfied
  const double* effective_mass = nullptr;  // 1 / (w_a + w_b + softness)
  const double* softness = nullptr;        // 1/kg; 0: rigid, as all are without this array
  const double* inverse_mass = nullptr;    // per particle

  VectorsView x;              // per particle, changed
  VectorsView n;              // per constraint, unit
  double* impulse = nullptr;  // per constraint, accumulated lambda: of unilateral ones and, where
                              // there is a softness, of all
  double limit = kUnlimited;  // largest |lambda| of one correction (paper 4.2)

  VectorsView start;                    // rattle: where directions are taken; null: at x
  const double* rest_length = nullptr;  // rattle: of what is not a contact
  double* start_target = nullptr;       // rattle: `target`, to be written
};

/// The change of constraint c's impulse that an error e out of tolerance calls for.
inline double bilateral_change(const Relaxation& r, std::size_t c, double e) {
  const double change = e * r.effective_mass[c];
  return r.limit < kUnlimited ? std::clamp(change, -r.limit, r.limit) : change;
}

/// The same for every kind and any error; 0 if c is satisfied or may not act. `impulse` is what it
/// has accumulated. An error that is not a number ends the loop rather than keep it busy: the step
/// is refused afterwards.
inline double impulse_change(const Relaxation& r, std::size_t c, double e, double impulse) {
  if (!(std::abs(e) > r.tolerance[c])) return 0;
  const double change = bilateral_change(r, c, e);
  if (c < r.bilateral) return change;
  if (c < r.pulling) return std::max(change, -impulse);
  return std::min(change, -impulse);
}

/// Adds to the accumulated impulse of a bilateral constraint, where it is read.
inline void accumulate(const Relaxation& r, std::size_t c, double change) {
  if (r.softness != nullptr) r.impulse[c] += change;
}

/// By how much a constraint may be longer than its target, with the impulse it has accumulated.
inline double give(const Relaxation& r, std::size_t c) {
  return r.softness != nullptr ? r.softness[c] * r.impulse[c] : 0;
}

/// Where d leads from end b to end a.
inline double error(const Relaxation& r, std::size_t c, Vector d) {
  return dot(r.n[c], d) - r.target[c] - give(r, c);
}
inline double error(const Relaxation& r, std::size_t c) {
  return error(r, c, r.x[r.a[c]] - r.x[r.b[c]]);
}

/// Moves both ends of c by an impulse.
inline void apply(const Relaxation& r, std::size_t c, double impulse) {
  const std::size_t a = r.a[c], b = r.b[c];
  const Vector j = impulse * r.n[c];
  r.x.add(a, -r.inverse_mass[a] * j);
  r.x.add(b, r.inverse_mass[b] * j);
}

inline double renew_direction_at_start(const Relaxation& r, std::size_t c) {
  const Vector d = r.x[r.a[c]] - r.x[r.b[c]], from = r.start[r.a[c]] - r.start[r.b[c]];
  const Vector n = direction(from, length(from));
  const double e = length(d) - r.rest_length[c];
  r.n.set(c, n);
  r.start_target[c] = dot(n, d) - e;
  return e;
}

/// Sets n_c along d, from end b to end a, and returns the error along it, which is then the true
/// error (paper 4.2: l = |n|, e = l - dist, n = n / l).
inline double renew_direction(const Relaxation& r, std::size_t c, Vector d) {
  const double l = length(d);
  r.n.set(c, direction(d, l));
  return l - r.target[c] - give(r, c);
}

/// The same from the positions x.
inline double renew_direction(const Relaxation& r, std::size_t c) {
  if (r.start.x != nullptr && c < r.pulling) return renew_direction_at_start(r, c);
  return renew_direction(r, c, r.x[r.a[c]] - r.x[r.b[c]]);
}

}  // namespace weft::reference
