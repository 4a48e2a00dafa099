#include "engine/mesh/woven_cell.h"

#include <algorithm>
#include <cmath>

#include "engine/tuning.h"

namespace weft::mesh {
namespace {

/// Two opposite sides beside the direction of their yarns.
struct Sides {
  double length = 0;       ///< m, the mean
  double tilt = 0;         ///< tangent of the mean angle
  double square_tilt = 0;  ///< mean of the squares
};

Sides sides_along(const Face& quad, std::size_t side, Vec3 along, Vec3 across) {
  Sides sides;
  for (const std::size_t i : {side, side + 2}) {
    const Vec3 vector = side_vector(quad, i);
    const double tilt = dot(vector, across) / dot(vector, along);
    sides.length += length(vector) / 2;
    sides.tilt += tilt / 2;
    sides.square_tilt += square(tilt) / 2;
  }
  return sides;
}

}  // namespace

std::optional<WovenCell> woven_cell(const Face& quad, Vec3 warp, const Material& material) {
  const Vec3 weft = cross(unit(area_vector(quad)), warp);
  const auto along_warp = [&](std::size_t side) {
    return std::abs(dot(unit(side_vector(quad, side)), warp)) +
           std::abs(dot(unit(side_vector(quad, side + 2)), warp));
  };
  WovenCell cell{.warp_side = along_warp(0) >= along_warp(1) ? 0u : 1u};
  const Sides warps = sides_along(quad, cell.warp_side, warp, weft);
  const Sides wefts = sides_along(quad, 1 - cell.warp_side, weft, warp);

  // Fabric with less shear than this is so soft in it that errors of it are not seen.
  const double felt_shear =
      std::max(material.shear, tuning::kFeltShear * std::max(material.warp, material.weft));
  const double softer =
      std::max(material.warp * square(warps.tilt), material.weft * square(wefts.tilt));
  const double of_sides = material.warp * warps.square_tilt + material.weft * wefts.square_tilt;
  if (!(softer <= tuning::kWovenError * felt_shear && of_sides <= felt_shear / 2)) return {};

  cell.shear = std::max(0.0, material.shear - of_sides);
  cell.warp = material.warp - cell.shear * square(warps.length / wefts.length);
  cell.weft = material.weft - cell.shear * square(wefts.length / warps.length);
  if (cell.warp < material.warp / 2 || cell.weft < material.weft / 2) return {};
  return cell;
}

}  // namespace weft::mesh
