/// Stiffnesses of bending elements with which all directions bend alike.
#pragma once

#include <vector>

#include "engine/mesh/bending.h"

namespace weft::mesh {

struct Calibrated {
  std::vector<double> weights;        ///< w per element, which stores k w (|d| - rest)^2 / 2
  std::vector<std::uint32_t> uneven;  ///< particles around which that is not enough, ascending
};

/// The mesh around each particle is to store what a cylinder of any direction stores, its area
/// times k c^2 / 2 at the curvature c. As a function of the direction of the cylinder the energy is
/// a polynomial of fourth degree, which five moments describe (moments.h).
///
/// Each element gets a factor: the product of its own moments, as fractions of the first, and five
/// coefficients, which are the mean of those at its particles. The coefficients at a particle solve
/// five equations, one for each moment of the energy around it, of means over its neighbours and
/// theirs (tuning::kBendingRings). So the factor depends on the direction of an element and changes
/// slowly over the mesh. Factors that fit each particle by itself would be exact there, but a sheet
/// of them is softer as a whole, because soft elements bend more than their share (perf/tried.md).
///
/// The energy that counts is that of a cylinder whose particles have settled (tuning::kSettlings).
/// Held exactly on a cylinder they store more, up to a tenth in irregular triangles; where elements
/// pull at particles evenly, as in lattices, it is the same.
///
/// Where the elements store what they should without a factor, as in grids of rectangles, they keep
/// the factor 1.
///
/// Panels that are sewn lie in planes of their own, each turned as it likes. So each is calibrated
/// by itself, up to the particles on its seams.
Calibrated calibrate(const std::vector<Face>& faces, const Edges& edges, const Stencils& stencils,
                     double weld_distance, std::size_t particles);

}  // namespace weft::mesh
