/// The closed seams of a cloth, and the speeds at which others close.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/saving/archive.h"
#include "engine/solvers/small_steps/seams.h"

namespace weft {

void visit_fields(Is<SeamState> auto& state, auto& archive) {
  auto& [speed, left, is_closed, is_released] = state;
  archive(speed, left, is_closed, is_released);
}

class Seams {
 public:
  Seams() = default;
  explicit Seams(const Model& model) : states_(model.seams.size()) {}

  /// Positions were given: a gap that they leave, m, closes in the time of its seam.
  void begin(const Model& model, const kernels::Vectors& x, double tolerance);
  /// Whether it was not released before.
  bool release(std::uint32_t seam) { return !std::exchange(states_[seam].is_released, true); }
  /// One that was released draws again, over the gap that there is now. Whether it was released.
  bool close(std::uint32_t seam, const Model& model, const kernels::Vectors& x, double tolerance);
  /// A step was done.
  void take(std::span<const SeamState> states) { states_.assign(states.begin(), states.end()); }

  /// The model was torn.
  void tear(const Model& model);

  std::span<const SeamState> states() const { return states_; }
  std::size_t bytes() const { return states_.capacity() * sizeof(SeamState); }
  friend void visit_fields(Is<Seams> auto& seams, auto& archive) {
    auto& [states] = seams;
    archive(states);
  }
  /// Whether those that were read are the model's.
  bool fit(const Model& model) const { return states_.size() == model.seams.size(); }

 private:
  std::vector<SeamState> states_;
};

/// The gaps of some states at x.
struct SeamGaps {
  int open = 0, late = 0;
  double largest = 0;                   // m, of closed ones
  std::uint32_t worst_late = kNoIndex;  // the one with the widest gap
};
SeamGaps measure_seams(const Model& model, std::span<const SeamState> states,
                       const kernels::Vectors& x);

}  // namespace weft
