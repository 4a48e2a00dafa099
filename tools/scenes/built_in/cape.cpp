/// The irregular mesh of triangles and quads of irregular_mesh.h, N x N points in an order of
/// chance: no grid. The edges of its faces are constraints of the length that they have. A strip x
/// < 1.19 L is fixed, an uneven row (N = 120: x < 0.01, 210 particles). Points that holes leave in
/// no face are particles only without a material.
#include <cstdint>
#include <utility>

#include "tools/scenes/built_in.h"
#include "tools/scenes/irregular_mesh.h"

namespace weft::scenes::built_in {
namespace {

Layout cape_layout(const Options& options) {
  IrregularMesh mesh = irregular_mesh(options.size);
  Layout layout;
  layout.start = std::move(mesh.points);
  layout.faces = std::move(mesh.faces);
  const double seam = 1.19 * Grid{options.size}.spacing();
  for (std::uint32_t i = 0; i < layout.start.size(); ++i) {
    if (layout.start[i].x < seam) layout.pins.push_back(i);
  }
  return layout;
}

}  // namespace

BuiltIn cape() {
  return {.summary = "an irregular mesh hangs from an uneven seam",
          .smallest_size = 3,
          .make = cloth<cape_layout>};
}

}  // namespace weft::scenes::built_in
