/// Rigid impact zones (Bridson, Fedkiw and Anderson, 2002): particles that went through each other
/// in an interval, in spite of impacts. The particles of a zone move as one rigid body, so that
/// none of them meets another. A free zone keeps the momentum and the angular momentum of its
/// particles. A zone with points of a body moves with the body, and one with a fixed particle moves
/// with that particle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/scene.h"

namespace weft {

class ImpactZones {
 public:
  /// Begins an interval.
  void begin();
  /// The points of a pair are in one zone from now on.
  void join(const std::array<std::uint32_t, 4>& points);
  std::size_t bytes() const;
  /// All neighbours of zones join them.
  void grow(const ContactScene& scene);
  /// Moves all particles of zones. time: s, of the interval.
  void move(const ContactScene& scene, double time);

 private:
  struct Rigid;
  std::uint32_t root_of(std::uint32_t point);
  void unite(std::uint32_t a, std::uint32_t b);
  void add(std::uint32_t point);
  Rigid motion_of(const ContactScene& scene, std::size_t first, std::size_t last,
                  double time) const;
  bool follows(const ContactPoints& points, std::size_t first, std::size_t last, Rigid& motion,
               double time) const;

  std::vector<std::uint32_t> parent_;  // per point: another one of its zone, or itself
  std::vector<bool> is_in_;            // per point
  std::vector<std::uint32_t> points_;  // in zones
};

}  // namespace weft
