/// What a state remembers of steps in which its solver gave up, or for which it took long.
///
/// care: after halves that helped, substeps are shorter and yarns solved more closely for a while.
/// What is left of a tolerance is noise that larger sheets carry farther: without this corners,
/// 101 x 101, at 1 % takes 300 ms a frame, most of it in sweeps, and 11 with it.
///
/// pause: where halves were no answer either, as at loose tolerances in a sheet of triangles, which
/// can hardly bend without stretching, they are not even tried for 1, 2, 4, ... steps.
///
/// only sweeps: where steps take more than kDear passes, the next 8, 16, ... are done by
/// Gauss-Seidel sweeps alone, which spread what cannot be solved over all of the cloth, up to the
/// tolerance; then yarns are tried again, once, without halves. Where sweeps take more than yarns
/// did, the next steps are as usual, whatever they take. (A sheet of 40 x 40 triangles hangs by a
/// row of particles that is not straight, and so is no hinge: at 1 %, 100 frames, 175 ms a frame
/// without, 40 with it, Gauss-Seidel alone 41; at 5 % 271, 10 and 4, and without it the sheet falls
/// a third as far. kDear 1000: sheets that hang by a corner are swept as well, and lose half as
/// much energy again.)
#pragma once

#include <algorithm>

namespace weft {

/// A step.
struct StepRecord {
  bool halved = false;
  bool helped = true;         // halves were an answer, or not asked
  bool made_do = false;       // with what else than the solver's solution
  bool only_sweeps = false;   // it began with those of Gauss-Seidel
  bool may_be_swept = false;  // the tolerance is loose enough for them
  double passes = 0;          // over all constraints
};

class Trouble {
 public:
  /// Of the usual bend; the square root of it of the error that yarns usually leave.
  double care() const { return care_; }
  bool may_halve() const { return pause_left_ == 0; }
  /// All but the last step of a pause, which tries yarns again.
  bool only_sweeps() const { return sweeping_ && pause_left_ > 1; }
  /// As many as yarns take.
  int most_sweeps() const { return static_cast<int>(std::min(mean_passes_, 1e6)); }

  /// After a step.
  void remember(const StepRecord& step) {
    yarns_left_ = std::max(0, yarns_left_ - 1);
    if (!step.only_sweeps) mean_passes_ += kShare * (step.passes - mean_passes_);
    if (step.only_sweeps && step.passes > mean_passes_) {
      end_pause();
      yarns_left_ = kLongestPause;
    } else if (pause_left_ > 0) {
      --pause_left_;
      if (sweeping_ && pause_left_ == 0 && step.made_do) begin_pause(kShortestSweeping);
    } else if (step.may_be_swept && std::min(step.passes, mean_passes_) > kDear &&
               yarns_left_ == 0) {
      sweeping_ = true;
      begin_pause(kShortestSweeping);
    } else if (!step.helped) {
      sweeping_ = false;
      begin_pause(1);
    } else {
      end_pause();
      care_ = step.halved ? kLeastCare : std::min(1.0, kRecovery * care_);
    }
  }

 private:
  void begin_pause(int least) {
    pause_ = std::clamp(2 * pause_, least, kLongestPause);
    pause_left_ = pause_;
    care_ = 1;
  }
  void end_pause() {
    pause_ = pause_left_ = 0;
    sweeping_ = false;
  }

  static constexpr double kLeastCare = 0.25;
  static constexpr double kRecovery = 1.01;  // per step
  static constexpr int kShortestSweeping = 8, kLongestPause = 64;
  static constexpr double kDear = 3000, kShare = 0.1;

  double care_ = 1;
  int pause_ = 0, pause_left_ = 0;  // steps
  bool sweeping_ = false;           // in this pause
  double mean_passes_ = 0;          // of steps by yarns, a running mean
  int yarns_left_ = 0;              // steps that are not swept, whatever they take
};

}  // namespace weft
