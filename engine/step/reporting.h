/// How the stages of a step write into its report.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <chrono>

namespace weft {

template <class Work>
void timed(StepReport& report, Stage stage, Work&& work) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  work();
  const std::chrono::duration<double> seconds = Clock::now() - start;
  report.stage_seconds[static_cast<std::size_t>(stage)] += seconds.count();
}

/// The worse of two: the enumerators are in order of severity.
inline void worsen(StepReport& report, Status status) {
  report.status = std::max(report.status, status);
}

}  // namespace weft
