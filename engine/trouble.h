/// What a state remembers of steps in which its solver gave up, or that were expensive.
///
/// allowance: after halving helped, substeps are shorter and yarns are solved more closely for a
/// while, the more so if halving is needed again soon. What is left of a tolerance is noise that
/// larger sheets carry farther: without this corners, 101 x 101, at 1 % takes 300 ms a frame, most
/// of it in sweeps, and 11 with it. (All of it at once: a sheet that needed halves once takes 1.3
/// times as long for a second, and large ones are no faster.)
///
/// pause: where halving failed too, as at loose tolerances in a sheet of triangles, which can
/// hardly bend without stretching, it is not even tried for 1, 2, 4, ... steps.
///
/// only sweeps: where steps by yarns average more than kExpensive passes, the next 8, 16, ... use
/// Gauss-Seidel sweeps alone, which spread what cannot be solved over all of the cloth, up to the
/// tolerance; then yarns are tried again, once, without halves. Where a step takes more sweeps than
/// yarns take passes on average, the next steps are as usual, whatever they take. Not where
/// there are spheres: a heavy one that yarns hold, late and not within tolerance, breaks through a
/// sheet that is only swept (sphere_drop_10_kg_taut of weft hard). (A sheet of 40 x 40 triangles
/// hangs by a row of particles that is not straight, and so is no hinge: at 1 %, 100 frames, 178 ms
/// a frame without, 36 with it, Gauss-Seidel alone 41; at 5 % 273, 5 and 4, and without it the
/// sheet falls a third as far. kExpensive 1000: sheets that hang by a corner are swept as well, and
/// lose half as much energy again.)
///     usual   -- halves failed --> no halves in 1, 2, 4 ... 64 steps --> usual
///     usual   -- expensive -----> only sweeps in 8, 16 ... 64 steps, the last by yarns, no halves
///                                 --> twice as many, if that one made do; else usual
///     sweeps  -- in vain -------> usual, and 64 steps that are not swept
#pragma once

#include <algorithm>

namespace weft {

/// A step.
struct StepRecord {
  bool halved = false;
  bool helped = true;        // halves were an answer, or not asked, or sweeps would be none
  bool made_do = false;      // with what else than the solver's solution
  bool only_sweeps = false;  // it began with those of Gauss-Seidel
  bool swept_in_vain = false;
  bool may_be_swept = false;  // by them alone: the tolerance is loose, and nothing presses
  double stood_at = 0;        // what its sweeps could not solve (standstill.h)
  double passes = 0;          // over all constraints
};

class Trouble {
 public:
  /// The share of the usual that may be left, 0.25 to 1: of the strain that decides about substeps
  /// (choose_substeps.cpp); of what yarns leave, its square root.
  double allowance() const { return allowance_; }
  bool may_halve() const { return pause_left_ == 0; }
  /// All but the last step of a pause, which tries yarns again.
  bool only_sweeps() const { return sweeping_ && pause_left_ > 1; }
  /// What sweeps could not solve in the last step; 0: nothing.
  double stood_at() const { return stood_at_; }
  /// As many as yarns take.
  int most_sweeps() const { return static_cast<int>(std::min(mean_passes_, 1e6)); }

  /// After a step.
  void remember(const StepRecord& step) {
    stood_at_ = step.stood_at;
    yarns_left_ = std::max(0, yarns_left_ - 1);
    if (!step.only_sweeps) {
      mean_passes_ += (step.passes - mean_passes_) / kMeanSteps;
      expense_ += (std::min(step.passes, kMostExpensive) - expense_) / kMeanSteps;
    }
    if (step.swept_in_vain || (step.only_sweeps && step.passes > mean_passes_)) {
      end_pause();
      yarns_left_ = kLongestPause;
    } else if (pause_left_ > 0) {
      --pause_left_;
      const bool again = sweeping_ && step.made_do && step.may_be_swept;
      if (again && pause_left_ == 0) begin_pause(kShortestSweeping);
    } else if (expense_ > kExpensive && step.may_be_swept && yarns_left_ == 0) {
      if (!sweeping_) end_pause();
      sweeping_ = true;
      begin_pause(kShortestSweeping);
    } else if (!step.helped) {
      if (sweeping_) end_pause();
      begin_pause(1);
    } else {
      end_pause();
      allowance_ = step.halved ? std::max(kLeastAllowance, allowance_ / 2)
                               : std::min(1.0, kRecovery * allowance_);
    }
  }

 private:
  void begin_pause(int least) {
    pause_ = std::clamp(2 * pause_, least, kLongestPause);
    pause_left_ = pause_;
    allowance_ = 1;
  }
  void end_pause() {
    pause_ = pause_left_ = 0;
    sweeping_ = false;
  }

  static constexpr double kLeastAllowance = 0.25;
  static constexpr double kRecovery = 1.01;  // per step
  static constexpr int kShortestSweeping = 8, kLongestPause = 64;
  static constexpr double kExpensive = 3000;
  static constexpr double kMostExpensive = 3 * kExpensive;  // of a step: one alone is not enough
  static constexpr double kMeanSteps = 4;

  double allowance_ = 1;
  double stood_at_ = 0;
  int pause_ = 0, pause_left_ = 0;  // steps
  bool sweeping_ = false;           // in this pause
  double mean_passes_ = 0;          // of steps by yarns, lately
  double expense_ = 0;              // the same, of no step more than kMostExpensive
  int yarns_left_ = 0;              // steps that are not swept, whatever they take
};

}  // namespace weft
