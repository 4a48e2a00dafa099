/// How stiff bending elements are to be, so that all directions bend alike.
#pragma once

#include <vector>

#include "engine/mesh/bending.h"

namespace weft::mesh {

struct Calibrated {
  std::vector<double> weights;        ///< w per element, which stores k w (|d| - rest)^2 / 2
  std::vector<std::uint32_t> uneven;  ///< particles around which that is not enough, ascending
};

/// The mesh around each particle, the faces that meet there, is to store what a cylinder of each of
/// eight directions stores, its area times k c^2 / 2 at the curvature c. (As a function of its
/// direction this is a polynomial of fourth degree, which eight directions determine.) That is a
/// system A s = t with nothing negative in it, for factors s of the elements. A fixed number of
/// steps of Richardson and Lucy's iteration, s_j <- s_j sum_i A_ij t_i / (A s)_i / sum_i A_ij,
/// keeps all factors above 0 and the sum of A s at that of t; where s = 1 solves the system, as in
/// grids of rectangles, it stays.
Calibrated calibrate(const std::vector<Face>& faces, const Stencils& stencils,
                     std::size_t particles);

}  // namespace weft::mesh
