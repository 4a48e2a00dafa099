/// The second half of making an Ordering: batches of runs and singles.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/runs.h"

namespace weft {

/// A planned constraint slot.
struct Joint {
  std::uint32_t a = 0, b = 0;     // slots, a < b except in padding
  std::uint32_t link = kNoIndex;  // kNoIndex: padding
};

struct PlannedBatch {
  std::vector<Joint> joints;       // runs, then singles
  std::vector<kernels::Run> runs;  // Run::constraint counts from the first joint
  std::uint32_t singles = 0;
  std::size_t links_in_runs = 0;
};

/// Plans batches that lie within a range of slots, one at a time.
class Batcher {
 public:
  /// particle_at lists the particle of each slot in the range. It grows by padding slots where the
  /// singles need them.
  explicit Batcher(std::vector<std::uint32_t>& particle_at);

  /// No slot may occur twice in `joints`.
  PlannedBatch plan(std::vector<Joint> joints, bool with_runs);

 private:
  using Joints = std::vector<Joint>;

  void find_runs(const Joints& joints);
  std::size_t extend(const Joints& joints, std::size_t first);
  bool fill_gap(const Joint& from, const Joint& to);
  void fill_lanes();
  void cut_lanes();
  void finish_run();
  void add_singles();
  bool claim(std::uint32_t a, std::uint32_t b);
  void release(const Joint& padding);
  std::uint32_t spare_slot();

  std::vector<std::uint32_t>& particle_at_;
  std::vector<bool> used_;  // by slot, in this batch
  std::vector<std::uint32_t> padding_slots_;
  std::size_t next_spare_ = 0;
  Joints run_, singles_;
  PlannedBatch batch_;
};

}  // namespace weft
