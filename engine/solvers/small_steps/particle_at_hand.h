/// A particle of small steps in double, in coordinates of the world, while contacts move it.
#pragma once

#include <cmath>

#include "engine/contact/particles.h"

namespace weft {

/// The fields are those of simd::Flight. Mending moves x alone; until then x is where motion leads.
struct ParticleAtHand {
  kernels::Vector start{}, x{};
  kernels::Vector predicted{}, led_to{};
  kernels::Vector v{};
  bool is_mended = false;
  double clear = 0;  // m, by which it may be moved before it can touch a body of a closed form

  /// rate: by which velocities settle.
  kernels::Vector settled(double rate) const { return v + rate * (led_to - predicted); }
  /// Its stop by contacts is no motion: it is predicted to be where it is.
  void stop(const ContactParticle& at) {
    clear -= longest(at.x - x) + longest(at.start - start);
    x = at.x;
    led_to = is_mended ? led_to + (at.start - start) : x;
    predicted = led_to;
    start = at.start;
    v = at.v;
  }
  /// Where it began, without speed, and where it is.
  void shift(kernels::Vector start_by, kernels::Vector by) {
    clear -= longest(start_by) + longest(by);
    start = start + start_by;
    predicted = predicted + start_by;
    x = x + by;
    led_to = is_mended ? led_to + start_by : x;
  }

 private:
  /// m, not less than its length.
  static double longest(kernels::Vector way) {
    return std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
  }
};

/// Returns whether a body of a closed form holds it. Points: LanePoints, or ReferenceStore::Points.
template <class Points>
bool hold_by_bodies(const Points& points, std::uint32_t slot, ParticleAtHand& particle) {
  if (particle.clear > 0) return false;
  particle.clear = points.bodies->clear_of(slot, particle.start, particle.x);
  if (particle.clear > 0) return false;
  ContactParticle at{particle.start, particle.x, particle.settled(points.rate)};
  const TouchedSurface surface = points.bodies->hold(slot, at);
  if (!surface.is_there()) return false;
  particle.stop(at);
  if (points.bodies->begins_to_touch(slot)) points.arrived.push_back({slot, surface});
  return true;
}

}  // namespace weft
