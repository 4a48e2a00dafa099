/// Shortest paths along links of given lengths.
#pragma once

#include <weft/scene.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/lists.h"

namespace weft {

/// A constraint, or a side of a triangle of fabric.
struct Join {
  std::uint32_t a = 0, b = 0;
  double length = 0;  // m
};

/// The joins of each particle.
Lists joins_at(std::size_t particles, std::span<const Join> joins);

/// The particle of some that is nearest to another one, and the way to it.
struct Nearest {
  double length = std::numeric_limits<double>::infinity();  // m
  std::uint32_t end = kNoIndex;
};
/// For each particle the nearest of `ends` along the joins (Dijkstra, 1959).
std::vector<Nearest> find_nearest(std::size_t particles, std::span<const std::uint32_t> ends,
                                  std::span<const Join> joins);

/// For each particle the nearest fixed one along constraints and sides of triangles of fabric.
std::vector<Nearest> find_nearest_pins(const SceneDescription& scene);

}  // namespace weft
