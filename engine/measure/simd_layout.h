/// The layout of a model for the vector kernels: the constraints in their slots, cut into
/// chunks.
///
///   constraint slots:  | batches of the ordering | hub distances | hub ropes |
///
/// A chunk is at most kChunk constraints of one batch, all in one run or all singles. It is the
/// unit of work of a kernel call, of sharing work between threads and of skipping: a chunk is
/// passed over unless something in it, or in a chunk that shares a particle with it, was corrected
/// since it was last visited.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/lists.h"
#include "engine/ordering/ordering.h"
#include "kernels/vectors.h"

namespace weft {

class Model;

inline constexpr std::uint32_t kChunk = 128;  // constraints at most
inline constexpr std::size_t kPiece = 16;     // chunks that one thread takes at a time

struct Chunk {
  kernels::Run run;        // singles: only constraint and length are meant
  std::uint32_t real = 0;  // constraints that are not padding
  bool singles = false;
  bool rope = false;
};

/// Chunks of the first batch between tiles whose slots are in tiles first_tile and following.
struct TileSeam {
  std::uint32_t first_chunk = 0, last_chunk = 0;
  std::uint32_t first_tile = 0;
};

struct SimdLayout {
  std::vector<Chunk> chunks;
  std::vector<kernels::Run> runs;            // of the chunks, side by side
  std::vector<std::uint32_t> batch_chunks;   // batch i: chunks batch_chunks[i] ... [i + 1] - 1,
  std::vector<std::uint32_t> batch_singles;  // its singles from batch_singles[i] on
  std::vector<TileSeam> seams;               // by the last tile that they need; those of tile i are
  std::vector<std::uint32_t> seams_at;  // [i] ... [i + 1] - 1, of padding [number of tiles] ...
  bool seams_join_neighbours = true;    // or further tiles

  std::size_t slots = 0;
  std::uint32_t hub_first = 0, hub_ropes = 0, hub_last = 0;  // constraint slots, not padded
  std::size_t constraint_slots = 0;                          // with padding to whole lanes
  std::vector<std::uint32_t> a, b;                           // per constraint slot
  std::vector<std::uint32_t> constraint_at;                  // in the ConstraintStore, or kNoIndex
  kernels::AlignedVector<double> rest_length;                // padding: 1
  kernels::AlignedVector<double> inverse_square;             // 1 / rest_length^2; padding: 0
  kernels::AlignedVector<double> share_a, share_b;           // w_a / (w_a + w_b), padding: 0
  bool has_ropes = false;
  // simd::SpringStiffness, with springs only; of rigid constraints and padding infinite and 0.
  kernels::AlignedVector<double> compliance, inverse_mass;

  std::size_t bytes() const;
};

SimdLayout make_simd_layout(const Model& model);

/// The data that sweeps that skip need besides.
struct ChunkNeighbours {
  Lists of;  // chunks that share a slot with chunk i, and i itself
  Lists at;  // slot -> chunks

  std::size_t bytes() const { return of.bytes() + at.bytes(); }
};

ChunkNeighbours find_chunk_neighbours(const SimdLayout& layout);

}  // namespace weft
