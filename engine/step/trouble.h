/// What a state remembers of steps in which its solver gave up.
///
/// allowance: after halving helped, substeps are shorter and yarns are solved more closely for a
/// while, the more so if halving is needed again soon. What is left of a tolerance is noise that
/// larger sheets carry farther: without this corners, 101 x 101, at 1 % takes 300 ms a frame, most
/// of it in sweeps, and 11 with it. (All of it at once: a sheet that needed halves once takes 1.3
/// times as long for a second, and large ones are no faster.)
///
/// pause: where halving failed too it is not even tried for 1, 2, 4, ... 64 steps.
#pragma once

#include <algorithm>

namespace weft {

/// A step.
struct StepRecord {
  bool halved = false;
  bool helped = true;   // halves were an answer, or not asked
  double stood_at = 0;  // what its sweeps could not solve (standstill.h)
};

class Trouble {
 public:
  /// The share of the usual that may be left, 0.25 to 1: of the strain that decides about substeps
  /// (choose_substeps.cpp); of what yarns leave, its square root.
  double allowance() const { return allowance_; }
  bool may_halve() const { return pause_left_ == 0; }
  /// What sweeps could not solve in the last step; 0: nothing.
  double stood_at() const { return stood_at_; }

  /// After a step.
  void remember(const StepRecord& step) {
    stood_at_ = step.stood_at;
    if (pause_left_ > 0) {
      --pause_left_;
    } else if (!step.helped) {
      pause_ = std::clamp(2 * pause_, 1, kLongestPause);
      pause_left_ = pause_;
      allowance_ = 1;
    } else {
      pause_ = 0;
      allowance_ = step.halved ? std::max(kLeastAllowance, allowance_ / 2)
                               : std::min(1.0, kRecovery * allowance_);
    }
  }

 private:
  static constexpr double kLeastAllowance = 0.25;
  static constexpr double kRecovery = 1.01;  // per step
  static constexpr int kLongestPause = 64;

  double allowance_ = 1;
  double stood_at_ = 0;
  int pause_ = 0, pause_left_ = 0;  // steps
};

}  // namespace weft
