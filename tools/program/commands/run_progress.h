/// How far `weft run` has come, and how long it still takes, on a terminal.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "tools/program/run/runner.h"
#include "tools/program/terminal/progress.h"

namespace weft::tools {

class RunProgress {
 public:
  explicit RunProgress(const RunPlan& plan);

  /// After every frame of every run. Runs of which nothing else is told are shown here.
  void add_frame();
  /// After frames of the first run: with their strain.
  void show(double max_strain);

 private:
  using Clock = std::chrono::steady_clock;
  std::string text(const std::string& detail) const;

  std::size_t frames_;  ///< of one run
  std::size_t before_;  ///< frames that the run does not do anew
  std::size_t runs_;
  TimeLeft left_;
  Clock::time_point last_ = Clock::now();
  ProgressLine line_;
};

}  // namespace weft::tools
