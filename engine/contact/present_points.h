/// The places of the points of near pairs in the present substep.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/particles.h"
#include "engine/contact/points.h"
#include "engine/sparse_array.h"

namespace weft {

class PresentPoints {
 public:
  explicit PresentPoints(const ContactPoints& points) : points_(points) {}

  /// These points alone are asked for in the substeps of the interval.
  void begin_interval(std::span<const std::uint32_t> asked);
  /// Places vertices of bodies where the present substep begins and ends.
  void place_vertices(const BodyClock& clock);
  /// Reads where particles of the cloth have come to.
  void read_cloth(const ContactParticles& cloth);
  /// Those of one pair alone, once they were moved: as the cloth keeps them.
  void read(const std::array<std::uint32_t, 4>& points, const ContactParticles& cloth) {
    for (const std::uint32_t point : points)
      if (points_.is_of_cloth(point)) set(point, cloth.read(point));
  }
  void set(std::uint32_t point, const ContactParticle& particle) {
    present_[point] = particle;
    const kernels::Vector x = particle.x - points_.origin();
    float* const quad = &quads_[4 * std::size_t{point}];
    quad[0] = static_cast<float>(x.x);
    quad[1] = static_cast<float>(x.y);
    quad[2] = static_cast<float>(x.z);
  }
  /// A point that was asked for: of the cloth, as it was last read.
  const ContactParticle& operator[](std::uint32_t point) const { return present_[point]; }
  /// In quads, from the origin of the points.
  const float* places() const { return quads_.data(); }
  std::size_t bytes() const;

 private:
  const ContactPoints& points_;
  std::vector<std::uint32_t> asked_;
  bool are_placed_ = false;  // those of bodies that stand still, too
  SparseArray<float> quads_;
  SparseArray<ContactParticle> present_;
};

}  // namespace weft
