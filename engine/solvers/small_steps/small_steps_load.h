/// The length of a substep, in closed form.
///
/// A relaxed sweep is a spring. Under the tension T it leaves a constraint the strain
///
///     h^2 T (w_a + w_b) / (omega L)
///
/// unless one block holds both the constraint and its load. At the bottom of a swing T is three
/// times the weight. With H particles of inverse mass w on the constraint, T = 3 g H / w, and the
/// strain is within the tolerance epsilon if
///
///     h = sqrt(omega epsilon L / (6 g H)).
///
/// H is the number of particles that a particle next to the pins carries. It is the hanging mass
/// over the mass of the particles on blocks with a pin; or the number of blocks between a pin and
/// the particle that is farthest from all pins, if that is larger. One is subtracted, since a block
/// carries its own particles, and (1 - omega) / 2 is added for the rest that a relaxed sweep leaves
/// of those. Where there are no yarns, or ropes beside them, the load may run through single
/// constraints one by one: there the way to the pin is counted in constraints. Cloth without pins,
/// in a scene of spheres, may come to hang over one: its way is half of that across it.
///
/// Anchors with the narrowest limits hold as pins do (anchors_that_hold). An anchor with a largest
/// distance of 0 is a pin. Another anchored particle can move in a sweep: it counts as a block of
/// its own, and carries all that hangs on it, its own yarn included.
///
/// A yarn between two pins whose length exceeds their distance by the share s sags with the slope
/// sqrt(6 s). Its tension is its load divided by that slope, where the slope is below 1.
///
/// Ropes from a pin to the middle of a cloth (tethers) are slack as long as the constraints between
/// hold, so they do not count unless a particle hangs on them alone. Free spheres that may lie on
/// the cloth add to the load.
///
/// A linkage (linkage.h) is one block, which carries its whole load and may turn over.
///
/// No other constraint should turn over within a substep. A particle that has fallen as far as the
/// cloth reaches from its pins, D, has the speed sqrt(2 g D), and h is at most a part of L over
/// that speed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/vectors.h"

namespace weft {

/// The load on the pins.
struct SmallStepsLoad {
  /// A yarn, or another way along constraints, between two pins.
  struct Span {
    std::uint32_t first_slot = 0, last_slot = 0;
    double length = 0;  // m, of its constraints
  };
  double particles = 0;    // that a block at a pin carries besides its own
  double held_mass = 0;    // kg, of the particles of all blocks at pins
  double mean_length = 0;  // m, of the constraints and sides of triangles of fabric
  double reach = 0;        // m, the longest way from a particle to its nearest pin
  std::vector<Span> spans;
  std::vector<Span> ways;  // the shortest between neighbouring pins, along what cannot lengthen
};

/// How many times its weight a cloth pulls at its pins at the bottom of a swing.
inline constexpr double kWeightsOfSwing = 3;

/// The burden of all that accelerates a cloth.
struct Burden {
  double acceleration = 0;           // m/s^2
  double mass = 0;                   // kg, of what lies on it
  double weights = kWeightsOfSwing;  // with so many times its weight it pulls at its pins
};

/// s; infinite where nothing hangs on a pin or an anchor, or could come to hang over a sphere.
double substep_length(const SmallStepsLoad& load, kernels::VectorsView x, const Burden& burden,
                      double tolerance);

/// Whether two pins are farther apart than the constraints between them can be within tolerance: no
/// state keeps these. place(slot): where it is.
template <class Place>
bool are_pins_too_far_apart(const SmallStepsLoad& load, double tolerance, Place&& place) {
  return std::ranges::any_of(load.ways, [&](const SmallStepsLoad::Span& way) {
    const double distance = length(place(way.first_slot) - place(way.last_slot));
    return distance > (1 + tolerance) * way.length;
  });
}

}  // namespace weft
