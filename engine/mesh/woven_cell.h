/// A quad of fabric as springs along its sides and diagonals, if these can represent the material.
#pragma once

#include <weft/mesh.h>

#include <cstdint>
#include <optional>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// N/m: what the springs of a quad carry. Its sides 0 and 2 or 1 and 3 run along the warp.
struct WovenCell {
  std::uint32_t warp_side = 0;  ///< 0 or 1
  double warp = 0;              ///< along the warp, by the sides
  double weft = 0;
  double shear = 0;  ///< by the diagonals
};

/// A quad with sides a along the warp and b along the weft, of area A = a b.
///
/// A shear by the angle g makes one diagonal of length l longer by g A / l and the other shorter:
/// two springs s store s (g A / l)^2, which is G g^2 A / 2 with s = G l^2 / (2 A). A stretch of the
/// warp by e makes both longer by e a^2 / l, which stores G (a / b)^2 e^2 A / 2: diagonals carry
/// G (a / b)^2 of the warp, and G (b / a)^2 of the weft. Sides carry the rest.
///
/// A side that is tilted against its yarn by the angle t carries k t^2 of shear, too, which is
/// taken from the diagonals. If opposite sides are tilted by the mean angle m, shear comes with a
/// stretch, and a cloth that is free to stretch is softer in shear by k m^2.
///
/// Nothing where springs of at least 0 would be farther from the material than kWovenError: where
/// the quad is skewed, or narrow.
std::optional<WovenCell> woven_cell(const Face& quad, Vec3 warp, const Material& material);

}  // namespace weft::mesh
