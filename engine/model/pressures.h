/// Pressures (weft.h) and the triangles that they are on.
#pragma once

#include <weft/scene.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernels/vectors.h"

namespace weft {

using SurfaceTriangle = std::array<std::uint32_t, 3>;
/// m, of a corner.
using SlotPlace = std::function<kernels::Vector(std::uint32_t)>;

/// work(corners) for each triangle of the part.
template <class Work>
void for_each_triangle(const Pressure& part, std::span<const SurfaceTriangle> surface,
                       Work&& work) {
  if (part.triangles.empty()) {
    for (const SurfaceTriangle& corners : surface) work(corners);
  } else {
    for (const std::uint32_t i : part.triangles) work(surface[i]);
  }
}
std::vector<SurfaceTriangle> triangles_of(const Pressure& part,
                                          std::span<const SurfaceTriangle> surface);

/// A side that is not of as many triangles in one direction as in the other; null: the triangles
/// close.
std::optional<std::pair<std::uint32_t, std::uint32_t>> find_border(
    std::span<const SurfaceTriangle> triangles);

/// m^3, that triangles which close enclose: more than 0 where their normals point outwards.
double enclosed_volume(std::span<const SurfaceTriangle> triangles, const SlotPlace& place);

/// Pieces of triangles that share corners.
struct AirPieces {
  std::vector<std::uint32_t> of;  // of each triangle: its piece
  std::vector<bool> is_open;      // of each piece
};
AirPieces find_air_pieces(std::span<const SurfaceTriangle> triangles);

/// With the volume of each gas, where it is that of these places.
std::vector<Pressure> with_volumes(std::span<const Pressure> pressures,
                                   std::span<const SurfaceTriangle> surface,
                                   const SlotPlace& place);

/// A gas whose triangles do not enclose it any more has no pressure.
void let_gas_out(std::vector<Pressure>& pressures, std::span<const SurfaceTriangle> surface);

/// known: valid ones. Triangles that one of the same number has are not looked at again.
Result<void> validate_pressures(std::span<const Pressure> pressures,
                                std::span<const Pressure> known,
                                std::span<const SurfaceTriangle> surface, const SlotPlace& place);

}  // namespace weft
