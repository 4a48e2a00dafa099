/// What the direct solver needs to know of a model: in which order the constraints are eliminated,
/// where the values of their matrix and of its factor stand.
///
///   rows     the constraints of the matrix, in the order of elimination (minimum degree, subtrees
///            in one stretch)
///   entries  every pair of constraints k > j that share a particle p:
///                A(k, j) = sigma_k sigma_j w_p n_k . n_j
///            Two constraints share at most one particle, or they would join the same two; so an
///            entry is one product.
///   fronts   A = L D L^T by dense parts (engine/solvers/direct/direct_fronts.h); entries stand in
///   the
///            order of the fronts that take them.
///
/// Not in the matrix are the bodies: free particles that couple too many constraints with each
/// other (spheres, and particles of more than kBodyDegree constraints). They would make a dense
/// block of the matrix; instead their motions stay unknowns beside it
/// (engine/solvers/direct/direct_solver.h). A constraint that has nothing but bodies and fixed
/// particles for its ends is a link between bodies.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/lists.h"
#include "engine/solvers/direct/direct_fronts.h"

namespace weft {

class Model;

struct DirectLayout {
  static constexpr std::size_t kBodyDegree = 64;

  std::vector<std::uint32_t> row_constraint;
  std::vector<std::uint32_t> a, b;  // slots, per row
  std::vector<double> diagonal;     // w_a + w_b without the bodies', per row

  std::vector<std::size_t> entry_begin;   // per front, and their end
  std::vector<std::uint32_t> entry_row;   // k
  std::vector<std::uint32_t> entry_with;  // j
  std::vector<std::uint32_t> entry_slot;  // p
  std::vector<double> entry_weight;       // sigma_k sigma_j w_p
  std::vector<std::size_t> entry_place;   // among the values of L

  DirectFronts fronts;

  Lists rows_at;                       // rows at each slot, those of a body included
  std::vector<std::uint32_t> links;    // constraints between bodies
  std::vector<std::uint32_t> bodies;   // slots
  std::vector<std::uint32_t> body_of;  // per slot, kNoIndex: none

  std::size_t rows() const { return row_constraint.size(); }
  std::size_t bytes() const;
};

DirectLayout make_direct_layout(const Model& model);

}  // namespace weft
