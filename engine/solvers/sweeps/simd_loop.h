/// The three verbs of kernels/loop.h on the vector kernels.
#pragma once

#include "engine/parallel/team.h"
#include "engine/solvers/sweeps/simd_system.h"

namespace weft {

class SimdLoop {
 public:
  struct Unknowns {
    kernels::VectorsView x{};      // position loop: moved; velocity loop: where the directions are
    kernels::VectorsView start{};  // position loop, rattle: where the directions are
    kernels::VectorsView v{};      // velocity loop: changed
    bool velocities() const { return v.x != nullptr; }
  };

  SimdLoop(SimdSystem& system, const Unknowns& unknowns, Team& team);

  void renew();
  kernels::Sweep sweep();
  /// So many, the sum of them.
  kernels::Sweep sweeps(int passes);
  void finish();

 private:
  /// Whose turn it is in a pass over the batches, and by what.
  enum class Turn : std::uint8_t {
    all,       // everybody's, by displacements
    products,  // that of distance constraints, by what they pull
    sums,      // the same: their sums become displacements
    ropes      // that of ropes, by displacements
  };
  struct Share {
    std::size_t first = 0, last = 0;  // tiles
  };
  SimdLoop(SimdSystem& system, ScaledConstraints& constraints, const Unknowns& unknowns,
           Team& team);
  bool skips() const { return !s_.changed_.empty(); }
  bool masks() const { return !s_.mask_.empty(); }
  bool has_springs() const { return s_.springs_.has_value(); }
  void apply_displacements();
  void renew_chunk(std::size_t i);
  void renew_run(const kernels::Run& run);
  void renew_singles(std::uint32_t first, std::uint32_t last);
  void renew_rest();
  void clear_sweeps();
  kernels::Sweep sum_of_sweeps() const;
  kernels::Sweep sweep_batches();
  kernels::Sweep sweep_tile(const Tile& tile);
  void sweep_share(const Share& share);
  kernels::Sweep sweep_seams(std::size_t tile, std::size_t from, std::size_t to);
  void leave_open(std::size_t tile, std::size_t first_tile);
  void sweep_open_seams(kernels::Sweep& sweep);
  kernels::Sweep sweep_batch_between_tiles(std::size_t batch);
  kernels::Sweep sweep_chunks(std::size_t batch, std::size_t first, std::size_t last);
  void relax_chunks(std::size_t batch, std::size_t first, std::size_t last, kernels::Sweep& sweep);
  void relax_runs(const Batch& batch, std::size_t first, std::size_t last, kernels::Sweep& sweep);
  void relax_one(const Batch& batch, std::size_t chunk, kernels::Sweep& sweep);
  bool marks() const { return skips() && !dense_; }
  bool wanted(std::size_t chunk) const { return !marks() || s_.changed_[chunk]; }
  // simd_anticipation.cpp
  bool anticipates() const { return s_.pulls_.has_value(); }
  bool has_others() const;
  bool has_turn(const Batch& batch) const;
  kernels::Sweep sweep_in_turn(Turn turn);
  kernels::Sweep sweep_others();
  void relax_anticipated(std::size_t first, std::size_t last, kernels::Sweep& sweep);
  void apply_sums();
  void apply_sums(std::size_t first, std::size_t last);
  void refresh_errors();
  void renew_products();
  void renew_products(std::size_t chunk);
  // simd_trips.cpp
  bool meets_neighbours_only() const;
  void sweep_trip(std::size_t depth, kernels::Sweep& sum);
  kernels::Sweep sweep_with_seams(std::size_t tile, std::size_t from);
  kernels::Sweep sweep_ahead(const Share& share, std::size_t depth);
  kernels::Sweep sweep_ends(const Share& share, std::size_t pass);
  void choose_density(const kernels::Sweep& sweep);
  void sweep_hubs(kernels::Sweep& sweep);
  void sweep_contacts(kernels::Sweep& sweep);
  void mark(std::size_t chunk);
  void mark_neighbours(std::size_t chunk);
  void mark_slots(const std::uint32_t* slots, std::size_t first, std::size_t last);

  SimdSystem& s_;
  const SimdLayout& layout_;
  const ChunkNeighbours& neighbours_;
  const simd::Table& table_;
  Unknowns unknowns_;
  simd::BlockRelaxation r_, contacts_;
  simd::Geometry g_, contact_geometry_;
  simd::Anticipation p_;
  Turn turn_ = Turn::all;
  bool renewed_ = false;
  Team& team_;
  /// So much is corrected that marking costs more than it saves: everything is visited.
  bool dense_ = true;
};

}  // namespace weft
