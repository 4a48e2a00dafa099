/// The neighbours of constraints, and memory for the methods of relax.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/reference/relaxation.h"

namespace weft::reference {

/// The neighbours of constraints, for anticipation and masks. Immutable; one per model.
struct Topology {
  /// Constraint c in [0, plain) shares a particle p, not a hub, with the constraints
  /// row_constraint[k], k in [row_begin[c], row_begin[c+1]), in ascending order; row_later[c] is
  /// the first k with row_constraint[k] > c. row_weight[k] = s w_p, s = +1 if p is the same end in
  /// both.
  const std::uint32_t* row_begin = nullptr;
  const std::uint32_t* row_later = nullptr;
  const std::uint32_t* row_constraint = nullptr;
  const double* row_weight = nullptr;

  /// Block i holds the plain constraints block_first[i] ... block_first[i+1] - 1, at most kBlock
  /// and all of one colour. It shares particles with the blocks block_neighbour[k], k in
  /// [block_begin[i], block_begin[i+1]).
  std::size_t blocks = 0;
  const std::uint32_t* block_first = nullptr;
  const std::uint32_t* block_of = nullptr;  // per plain constraint
  const std::uint32_t* block_begin = nullptr;
  const std::uint32_t* block_neighbour = nullptr;

  /// Constraints at particle p: adjacent_constraint[k], k in [adjacent_begin[p],
  /// adjacent_begin[p+1]); contacts are not among them.
  const std::uint32_t* adjacent_begin = nullptr;
  const std::uint32_t* adjacent_constraint = nullptr;

  const std::uint8_t* hub = nullptr;     // per particle
  const std::uint8_t* colour = nullptr;  // per plain constraint; < 64
};

/// Which contacts a particle is in: a linked list through the contacts. null: no contacts.
struct ContactLists {
  const std::uint32_t* first = nullptr;  // per particle; kNoContact ends a list
  const std::uint32_t* next = nullptr;   // per contact (constraint index minus `pulling`)
};
inline constexpr std::uint32_t kNoContact = 0xffffffffu;

/// Memory that the methods need, sized by the caller; contents need not survive a call. Only the
/// arrays of the method in use are touched.
struct Workspace {
  double* error = nullptr;        // anticipation: per constraint
  double* pending = nullptr;      // anticipation: impulse not yet in x, per constraint
  double* row_product = nullptr;  // anticipation: per row entry, s w_p n_i . n_j
  Flag* row_ready = nullptr;      // anticipation: per plain constraint
  VectorsView hub_motion;         // anticipation: per particle, hubs only
  std::span<const std::uint32_t> hubs;
  Flag* changed = nullptr;        // anticipation + skip: per block
  std::uint64_t* mask = nullptr;  // skip without anticipation: per particle
  Flag* moved = nullptr;          // skip: per particle, since its directions were renewed
};

}  // namespace weft::reference
