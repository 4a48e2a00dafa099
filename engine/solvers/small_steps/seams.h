/// The seams of small steps (kernels/reference/seams.h), one after the other, on either backend.
///
/// points: difference(a, b), start_difference(a, b) and move(slot, by) as for constraints (laws.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "kernels/reference/seams.h"

namespace weft {

/// The state of a seam as a cloth moves.
struct SeamState {
  double speed = 0;  // m/s, at which it closes
  double left = 0;   // s, of its time
  bool is_closed = false;
  bool is_released = false;  // by the caller: it does nothing

  bool is_open() const { return !is_closed && !is_released; }
  bool is_late() const { return is_open() && left <= 0; }
};

class SeamThreads {
 public:
  explicit SeamThreads(const Model& model)
      : model_(model), multiplier_(model.seams.size()), joined_(joined_seams(model)) {}

  bool empty() const { return multiplier_.empty(); }
  /// A frame of substeps of h. 0: no time passes, and open seams stay as they are.
  void begin(std::span<const SeamState> states, double h) {
    states_.assign(states.begin(), states.end());
    h_ = h;
    work_ = 0;
  }

  /// The end of a sweep, or of local passes. give: (b h)^2 of the substep. is_first: nothing of it
  /// was swept before.
  template <class Points>
  void draw(const Points& points, double give, bool is_first) {
    if (is_first) std::ranges::fill(multiplier_, kernels::Vector{});
    for (std::uint32_t i = 0; i < multiplier_.size(); ++i) draw_one(points, i, give);
  }
  /// Those that share a particle with others, or with a slider: another turn. Returns how
  /// far one was from what it asks for at most, m.
  template <class Points>
  double draw_joined(const Points& points, double give) {
    double most = 0;
    for (const std::uint32_t i : joined_) most = std::max(most, draw_one(points, i, give));
    return most;
  }

  /// The end of a substep. closed(slot, slot): these two have come together, as near as the
  /// tolerance, m.
  template <class Points, class Closed>
  void end_substep(const Points& points, double give, double tolerance, Closed&& closed) {
    for (std::size_t i = 0; i < multiplier_.size(); ++i) {
      if (!states_[i].is_open() || model_.seams.is_broken(i)) continue;
      states_[i].left -= h_;
      const std::uint32_t a = model_.seams.a[i], b = model_.seams.b[i];
      const kernels::Vector d = points.difference(a, b);
      work_ += dot(multiplier_[i], points.start_difference(a, b) - d) / give;
      if (length(d) > tolerance) continue;
      states_[i].is_closed = true;
      closed(a, b);
    }
  }

  /// kg m, of the present substep.
  kernels::Vector multiplier(std::size_t seam) const { return multiplier_[seam]; }
  std::span<const SeamState> states() const { return states_; }
  /// J, that open seams have done in the frame.
  double work() const { return work_; }
  std::size_t bytes() const {
    return multiplier_.capacity() * sizeof(kernels::Vector) +
           states_.capacity() * sizeof(SeamState) + joined_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static std::vector<std::uint32_t> joined_seams(const Model& model) {
    std::vector<std::uint8_t> joints(model.seams.size() > 0 ? model.slots() : 0);
    const auto add = [&](std::uint32_t slot) {
      if (joints[slot] < 2) ++joints[slot];
    };
    if (joints.empty()) return {};
    for (std::size_t i = 0; i < model.seams.size(); ++i)
      add(model.seams.a[i]), add(model.seams.b[i]);
    std::ranges::for_each(model.sliders.slot, add);
    std::ranges::for_each(model.sliders.rail, add);
    std::vector<std::uint32_t> joined;
    for (std::uint32_t i = 0; i < model.seams.size(); ++i)
      if (joints[model.seams.a[i]] > 1 || joints[model.seams.b[i]] > 1) joined.push_back(i);
    return joined;
  }
  template <class Points>
  double draw_one(const Points& points, std::uint32_t i, double give) {
    if (model_.seams.is_broken(i) || states_[i].is_released) return 0;
    const std::uint32_t a = model_.seams.a[i], b = model_.seams.b[i];
    const double wa = model_.inverse_mass[a], wb = model_.inverse_mass[b];
    if (wa + wb == 0) return 0;
    const kernels::Vector by = reference::seam_impulse(
        task(points, i, give), points.difference(a, b), wa + wb, multiplier_[i]);
    multiplier_[i] = multiplier_[i] + by;
    points.move(a, -wa * by);
    points.move(b, wb * by);
    return (wa + wb) * length(by);
  }
  template <class Points>
  reference::SeamTask task(const Points& points, std::size_t i, double give) const {
    if (states_[i].is_closed) return {{0, 0, 0}, std::numeric_limits<double>::infinity()};
    const SeamStore& s = model_.seams;
    return reference::SeamTask::of_open(points.start_difference(s.a[i], s.b[i]), states_[i].speed,
                                        h_, s.force[i] * give);
  }

  const Model& model_;
  std::vector<kernels::Vector> multiplier_;  // kg m
  std::vector<std::uint32_t> joined_;        // seams that share a particle
  std::vector<SeamState> states_;
  double h_ = 0, work_ = 0;
};

}  // namespace weft
