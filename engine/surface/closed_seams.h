/// Seams that have closed: particles at one place, which are drawn as one.
#pragma once

#include <weft/scene.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/surface/normals.h"

namespace weft::surface {

/// Seams of a cloth by their particles, and a workspace. It allocates nothing once it is made.
class ClosedSeams {
 public:
  ClosedSeams() = default;
  /// reach: m, as far apart are the ends of a closed seam at most.
  ClosedSeams(std::span<const Seam> seams, std::size_t particles, double reach);

  /// Puts the particles of each closed seam at their mean.
  void join(std::span<Vec3> particles);
  /// Gives them the sum of their normals, none of which is a unit yet.
  void add_up(std::span<Quad> normals) const;
  std::size_t bytes() const;

 private:
  std::uint32_t root(std::uint32_t particle) const;
  /// work(particle, its group), of each particle of a seam that is not the first of its group.
  template <class Work>
  void for_joined(Work&& work) const;

  std::vector<Seam> seams_;
  double square_ = 0;                     // m^2, of the reach
  std::vector<std::uint32_t> particles_;  // of seams, ascending
  std::vector<std::uint32_t> first_;      // per particle: one of its group, in the end the first
  std::vector<std::uint32_t> count_;      // per particle that is the first of a group
};

/// m, of the sides of triangles, a share of which is the reach of a closed seam.
double seam_reach(std::span<const Triangle> triangles, std::span<const Vec3> points);

}  // namespace weft::surface
