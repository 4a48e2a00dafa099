/// A particle beside each bending element of three particles: it tells how the element turns about
/// its ends (kernels/reference/bending.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace weft {

class Model;

/// Per element: of the particles that are two joins away from its middle one, the one farthest from
/// the line of its ends at the start. An element of four particles has none, nor has a yarn by
/// itself. Particles one join away tell mostly noise (perf/tried.md).
std::vector<std::optional<std::uint32_t>> particles_beside(const Model& model);

}  // namespace weft
