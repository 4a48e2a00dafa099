/// The memory layout of the yarns of a model, for the yarn solver.
///
///   families   the yarns of a family share no particle: all of them may be solved at once
///   block      kLanes yarns of a family, of about the same length, a lane each
///   row        particle k of these yarns, and what joins it to particle k + 1
///
///     family 0: | block | block | ... | family 1: | block | ...
///     block:    | row 0 | row 1 | ... | row of the last particles |
///
/// Rows with the same lengths and masses in all lanes share one YarnRow, kinds[kind[row]].
///
/// A closed yarn is cut open: its last link becomes a yarn of its own, in another family.
/// Constraints that no yarn can contain (ropes, which only pull, and constraints at hubs) are left
/// to SingleConstraints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solvers/yarn/yarn_places.h"
#include "engine/solvers/yarn/yarn_spans.h"
#include "kernels/simd/table.h"

namespace weft {

class Model;

/// The blocks of a family are divided into at most this many shares, each with a scratch of its
/// own.
inline constexpr std::size_t kMostYarnShares = 16;

struct YarnLayout {
  std::vector<simd::YarnBlock> blocks;
  std::vector<std::uint32_t> links;       // per block: its number of constraints
  std::vector<std::uint32_t> constraint;  // per row and lane: the one to the next row, or kNoIndex
  std::vector<std::uint32_t> family_begin;      // blocks of family f: [f], ... [f + 1] - 1
  std::vector<std::uint32_t> slot;              // per row and lane; only if blocks are in quads
  std::vector<simd::YarnPatch> patches;         // only if blocks are woven
  std::vector<std::uint32_t> kind;              // per row
  kernels::AlignedVector<simd::YarnRow> kinds;  // inverse masses in 1 / lightest
  std::vector<std::uint32_t> not_in_second;     // places that yarn_push_first does not write
  std::vector<YarnSpan> spans;
  std::vector<std::uint32_t> span_slots;  // the particles of all spans, with their ends
  YarnPlaces places;

  double lightest = 1;      // kg, of the particles that constraints join
  double cell = 0;          // m, the grid of base positions (kernels/simd/yarn_rows.h)
  std::size_t longest = 0;  // rows of the longest block
  /// Per chunk of model.simd(): the rows of the longest yarn that has a constraint in it. Empty if
  /// all yarns have the same length.
  std::vector<std::uint32_t> longest_at;

  /// Whether the displacements do not fit into the caches.
  bool from_memory() const { return places.floats * sizeof(float) > kernels::kCachedBytes; }
  /// The scratch has one row more than the longest block (kernels/simd/yarn_arrays.h), and as many
  /// again for the base where there are patches.
  std::size_t scratch_rows() const { return (patches.empty() ? 1 : 2) * (longest + 1); }
  std::size_t rows() const { return kind.size(); }
  std::size_t families() const { return family_begin.size() - 1; }
  std::size_t bytes() const;
};

/// With `quads` even a model that could be woven is laid out in quads.
enum class YarnMemory : std::uint8_t { woven_if_possible, quads };

/// The layout of these distance constraints, which are not at hubs. spans_first: families are in an
/// order by which linear systems converge where spans are taut.
YarnLayout make_yarn_layout(const Model& model, std::span<const std::uint32_t> constraints,
                            YarnMemory memory, bool spans_first);
/// The layout of all of them, for the yarn solver. In scenes with spheres that order saves it no
/// iterations, and gains energy.
YarnLayout make_yarn_layout(const Model& model);

/// Per slot.
std::vector<Vec3> initial_positions(const Model& model);

}  // namespace weft
