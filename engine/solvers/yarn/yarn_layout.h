/// Where the yarns of a model stand in memory, for the yarn solver.
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
/// A closed yarn is cut: its last link is a yarn of its own, in another family. What no yarn can
/// hold (ropes, which only pull, and constraints at hubs) is left to SingleConstraints.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/solvers/yarn/yarn_places.h"
#include "engine/solvers/yarn/yarn_spans.h"
#include "kernels/simd/table.h"

namespace weft {

class Model;

struct YarnLayout {
  std::vector<simd::YarnBlock> blocks;
  std::vector<std::uint32_t> links;             // constraints of each block
  std::vector<std::uint32_t> constraint;        // per row and lane: to the next row, or kNoIndex
  std::vector<std::uint32_t> family_begin;      // blocks of family f: [f], ... [f + 1] - 1
  std::vector<std::uint32_t> slot;              // per row and lane, where blocks are in quads
  std::vector<simd::YarnPatch> patches;         // where they are woven
  std::vector<std::uint32_t> kind;              // per row
  kernels::AlignedVector<simd::YarnRow> kinds;  // masses in lightest
  std::vector<std::uint32_t> not_in_second;     // places that yarn_push_first does not write
  std::vector<YarnSpan> spans;
  std::vector<std::uint32_t> span_slots;  // of their particles, both ends included
  YarnPlaces places;

  double lightest = 1;                    // kg, of the particles that constraints join
  double cell = 0;                        // that positions are split by (kernels/simd/yarn_rows.h)
  std::size_t longest = 0;                // rows of the longest block
  std::vector<std::uint32_t> longest_at;  // per chunk of model.simd(): of those yarns with a
                                          // constraint there; empty if all yarns are as long

  /// Whether displacements are too many for the caches.
  bool from_memory() const { return places.floats * sizeof(float) > kernels::kCachedBytes; }
  /// One behind those of a block (kernels/simd/yarn_arrays.h); for patches of the base as many.
  std::size_t scratch_rows() const { return (patches.empty() ? 1 : 2) * (longest + 1); }
  std::size_t rows() const { return kind.size(); }
  std::size_t families() const { return family_begin.size() - 1; }
  std::size_t bytes() const;
};

/// quads: all of it, also what could be woven.
enum class YarnMemory : std::uint8_t { woven_if_possible, quads };

YarnLayout make_yarn_layout(const Model& model, YarnMemory memory = YarnMemory::woven_if_possible);

}  // namespace weft
