/// Chains, trees and bridges of rigid links and ropes that hang from one particle at most: which
/// constraints linkage.h solves together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/solvers/small_steps/linkage_factor.h"

namespace weft {

class Model;

/// The unknowns of a linkage in the order of their elimination: three of each particle that moves,
/// and one of each link behind those of its first particle.
struct LinkageLayout {
  /// Where the values of a link are among those of the matrix, -1 where an end is fixed.
  struct Places {
    using Axes = std::array<int, 3>;
    Axes of_a, of_b;      // on the diagonal
    Axes between;         // of a and b
    Axes with_a, with_b;  // of the link and an end
    int own = 0;          // on the diagonal
  };
  std::vector<std::uint32_t> slots;  // particles that move
  std::vector<int> row_of_slot;      // one per particle: the first of its three unknowns
  std::vector<int> row_of_link;      // one per constraint
  SparsePattern matrix;
  FactorPattern factor;
  std::vector<Places> places;                // one per constraint
  std::vector<Places::Axes> places_of_slot;  // one per particle, on the diagonal
  bool empty() const { return row_of_link.empty(); }
  std::size_t bytes() const;
};

/// The layout of all constraints of a model that is_linkage(); empty for any other model.
LinkageLayout make_linkage_layout(const Model& model);

/// Whether the model is one of chains (engine/model/chains.h), none is a spring, one particle at
/// most is held, and no yarns in lanes will do: these do not tell what each constraint carries.
bool is_linkage(const Model& model);

}  // namespace weft
