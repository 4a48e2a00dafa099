/// The three verbs of kernels/loop.h on the vector kernels.
#pragma once

#include <atomic>

#include "engine/simd_solver.h"

namespace weft {

inline constexpr std::size_t kPiece = 16;  // chunks that one thread takes at a time

class SimdLoop {
 public:
  struct Unknowns {
    kernels::VectorsView x;  // position loop: moved; velocity loop: where the directions are
    kernels::VectorsView v;  // velocity loop: changed
    bool velocity = false;
  };

  SimdLoop(SimdSolver& solver, const Unknowns& unknowns, Team& team);

  void renew();
  kernels::Sweep sweep();
  void finish() { apply_displacements(); }

 private:
  /// What happened to a chunk, or to one that shares a particle with it: something was corrected
  /// since it was last visited; since its directions were last renewed.
  enum ChunkFlag : std::uint8_t { kChanged = 1, kStale = 2 };

  bool skips() const { return !s_.flags_.empty(); }
  bool masks() const { return !s_.mask_.empty(); }
  void apply_displacements();
  void renew_chunk(std::size_t i);
  void renew_rest();
  kernels::Sweep sweep_chunks(std::size_t first, std::size_t last);
  kernels::Sweep sweep_batch_between_tiles(std::size_t batch);
  void sweep_chunk(std::size_t i, kernels::Sweep& sweep);
  std::uint32_t relax(const Chunk& chunk, kernels::Sweep& sweep);
  void sweep_hubs(kernels::Sweep& sweep);
  void sweep_contacts(kernels::Sweep& sweep);
  void mark_neighbours(std::size_t chunk);
  void mark_slots(const std::uint32_t* slots, std::size_t first, std::size_t last);

  SimdSolver& s_;
  const SimdLayout& layout_;
  const simd::Table& table_;
  Unknowns unknowns_;
  simd::Relaxation r_, contacts_;
  simd::Geometry g_, contact_geometry_;
  Team& team_;
};

}  // namespace weft
