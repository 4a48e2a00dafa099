/// The layout of a model for the direct solver: the order in which constraints are eliminated, and
/// the places of the values of the matrix and of its factor.
///
///   rows     the constraints of the matrix, in the order of elimination (minimum degree,
///            postorder)
///   entries  every pair of constraints k > j that share a particle p:
///                A(k, j) = sigma_k sigma_j w_p n_k . n_j
///            Two constraints share at most one particle, since no two join the same particles.
///            So an entry is one product.
///   fronts   A = L D L^T by dense parts (engine/solvers/direct/direct_fronts.h). Entries are in
///            the order of the fronts that contain them.
///
/// Bodies are not in the matrix. They are free particles that would couple too many constraints
/// with each other: spheres, and particles of more than tuning::kBodyDegree constraints, which
/// would make dense blocks. Their motions are unknowns beside the matrix
/// (engine/solvers/direct/direct_bodies.h). A constraint whose ends are bodies or fixed particles
/// only is a link between bodies.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/lists.h"
#include "engine/solvers/direct/direct_fronts.h"

namespace weft {

class Model;

struct DirectLayout {
  std::vector<std::uint32_t> row_constraint;
  std::vector<std::uint32_t> a, b;  // slots, per row
  std::vector<double> diagonal;     // w_a + w_b per row; w of a body is 0

  std::vector<std::size_t> entry_begin;   // per front, and the end of the last
  std::vector<std::uint32_t> entry_row;   // k
  std::vector<std::uint32_t> entry_with;  // j
  std::vector<std::uint32_t> entry_slot;  // p
  std::vector<double> entry_weight;       // sigma_k sigma_j w_p
  std::vector<std::size_t> entry_place;   // index among the values of L

  DirectFronts fronts;

  Lists rows_at;                       // rows at each slot, also at those of bodies
  std::vector<std::uint32_t> links;    // constraints between bodies
  std::vector<std::uint32_t> bodies;   // slots
  std::vector<std::uint32_t> body_of;  // per slot: index in bodies, or kNoIndex

  std::size_t rows() const { return row_constraint.size(); }
  std::size_t bytes() const;
};

DirectLayout make_direct_layout(const Model& model);

}  // namespace weft
