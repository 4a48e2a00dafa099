/// The arrays that the kernels work on, for one mesh in one ordering, without a solver around them.
/// Errors are of a kind that no sweep brings to rest (fill_errors), so that the millionth pass
/// costs what the first did.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/ordering/ordering.h"
#include "engine/solvers/sweeps/pull_layout.h"
#include "kernels/simd/table.h"
#include "perf/meshes.h"

namespace weft::perf {

/// At most kChunk constraints, all in one run or all singles: the engine's unit of work (Chunk).
struct Piece {
  kernels::Run run;
  std::uint32_t colour = 0;
  bool singles = false;
  std::uint32_t first() const { return run.constraint; }
  std::uint32_t last() const { return run.constraint + run.length; }
};

class Workbench {
 public:
  Workbench(const SceneDescription& scene, const OrderingOptions& options);

  std::size_t particles = 0, constraints = 0;  // real ones
  std::size_t slots() const { return ordering.slots(); }
  std::size_t constraint_slots() const { return ordering.constraint_slots(); }
  Ordering ordering;
  std::vector<Piece> pieces;       // in the order of a pass
  std::vector<kernels::Run> runs;  // of the pieces
  struct Range {
    std::size_t first, singles, last;
  };
  std::vector<Range> batches;  // pieces of each; those from `singles` on are singles

  simd::BlockRelaxation relaxation(bool in_quads = false);
  simd::Geometry geometry();
  simd::Motion motion();
  simd::Boxes boxes();
  const PullLayout& pulls();  // made when first asked for
  simd::Anticipation anticipation(float threshold);

  kernels::Vectors position, velocity, solved, next_velocity;
  kernels::AlignedVector<double> inverse_mass, mass, reach;
  std::vector<std::uint32_t> near;  // room for find_near
  kernels::Vectors box_low, box_high;
  kernels::AlignedVector<float> base, change;  // quads
  kernels::AlignedVector<float> impulse;
  std::vector<std::uint64_t> mask;

 private:
  void place_particles(const SceneDescription& scene);
  void place_constraints(const SceneDescription& scene);
  void cut_pieces();
  void cut(const kernels::Run& run, const Batch& batch, bool singles);
  void fill_errors();

  simd::ConstraintBlock& block(std::size_t constraint) { return blocks_[constraint / kLanes]; }

  kernels::AlignedVector<float> u_;
  std::size_t stride_ = 0;
  kernels::AlignedVector<simd::ConstraintBlock> blocks_;
  kernels::AlignedVector<double> rest_length_, inverse_square_, scale_;
  std::unique_ptr<PullLayout> pulls_;
  std::unique_ptr<PullMemory> pull_memory_;
  kernels::AlignedVector<float> pull_weight_;
};

/// Workbenches by mesh ("grid", "irregular"), size and whether all are singles; made when first
/// asked for.
class Workshop {
 public:
  Workbench& get(const std::string& mesh, int size, bool singles);

 private:
  std::map<std::tuple<std::string, int, bool>, std::unique_ptr<Workbench>> benches_;
};

}  // namespace weft::perf
