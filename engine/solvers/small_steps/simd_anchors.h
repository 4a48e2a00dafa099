/// The anchors of small steps in lanes.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/anchor_layout.h"
#include "engine/solvers/small_steps/anchor_travel.h"
#include "kernels/simd/table.h"

namespace weft {

class SimdAnchors {
 public:
  SimdAnchors(const Model& model, const Settings& settings, const simd::Table& table);

  /// The particles at a limit when the last substep of a frame ended, per block.
  using AtLimit = std::vector<std::uint16_t>;

  bool empty() const { return layout_.empty(); }
  const AnchorClock& clock() const { return clock_; }
  /// before: of the frame before; empty: nothing is known of it.
  void begin(const AnchorTravel& travel, double h, int substeps,
             std::span<const std::uint16_t> before);
  /// Measures a new base.
  void measure_base(const float* base);
  /// Advances by a substep.
  void advance();
  /// After a sweep; v settles by `rate`.
  void hold(const simd::Flight& flight, float rate, Team& team);
  /// arrived(slot): it came to a limit, once in a substep, that it had not been at before. moved(
  /// slot): it was moved as far as a constraint of its own may be in error.
  template <class Arrived, class Moved>
  void report(Arrived&& arrived, Moved&& moved) const;
  const AtLimit& at_limit() const { return at_limit_; }
  std::size_t bytes() const;

 private:
  void write_backstops();
  void write_limits();

  const Model& model_;
  const AnchorLayout& layout_;
  const simd::Table& table_;
  AnchorClock clock_;
  kernels::AlignedVector<simd::AnchorBlock> blocks_;
  kernels::AlignedVector<simd::BackstopBlock> backstops_;
  bool limited_ = false;            // blocks have other limits than the model
  AtLimit at_limit_, before_;       // in this substep, in the last one
  AtLimit held_, arrived_, moved_;  // by the last sweep
};

template <class Arrived, class Moved>
void SimdAnchors::report(Arrived&& arrived, Moved&& moved) const {
  const auto for_each = [&](std::size_t block, std::uint32_t bits, auto&& work) {
    for (; bits != 0; bits &= bits - 1) {
      const std::size_t lane = static_cast<std::size_t>(std::countr_zero(bits));
      work(model_.anchors.slot[layout_.anchor[block * kernels::kLanes + lane]]);
    }
  };
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    for_each(i, arrived_[i], arrived);
    for_each(i, moved_[i], moved);
  }
}

}  // namespace weft
