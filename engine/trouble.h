/// What a state remembers of steps in which its solver gave up.
///
/// care: after halves that helped, substeps are shorter and yarns solved more closely for a while.
/// What is left of a tolerance is noise that larger sheets carry farther: without this corners,
/// 101 x 101, at 1 % takes 300 ms a frame, most of it in sweeps, and 11 with it.
///
/// pause: where halves were no answer either, as at loose tolerances in a sheet of triangles, which
/// can hardly bend without stretching, they are not even tried for 1, 2, 4, ... steps (40 x 40
/// triangulated at random, 1 %: 143 ms a frame without, 42 with it, Gauss-Seidel alone 22).
#pragma once

#include <algorithm>

namespace weft {

class Trouble {
 public:
  /// Of the usual bend; the square root of it of the error that yarns usually leave.
  double care() const { return care_; }
  bool may_halve() const { return pause_left_ == 0; }

  /// After a step.
  void remember(bool halved, bool helped) {
    if (!helped) {
      pause_ = std::clamp(2 * pause_, 1, kLongestPause);
      pause_left_ = pause_;
      care_ = 1;
    } else if (pause_left_ > 0) {
      --pause_left_;
    } else {
      pause_ = 0;
      care_ = halved ? kLeastCare : std::min(1.0, kRecovery * care_);
    }
  }

 private:
  static constexpr double kLeastCare = 0.25;
  static constexpr double kRecovery = 1.01;  // per step
  static constexpr int kLongestPause = 64;

  double care_ = 1;
  int pause_ = 0, pause_left_ = 0;  // steps
};

}  // namespace weft
