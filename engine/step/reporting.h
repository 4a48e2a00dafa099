/// How the stages of a step write into its report.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <chrono>
#include <numeric>

namespace weft {

/// The time of the work counts for the stage, but for what counts for others within.
template <class Work>
void timed(StepReport& report, Stage stage, Work&& work) {
  using Clock = std::chrono::steady_clock;
  const auto counted = [&] {
    return std::accumulate(report.stage_seconds.begin(), report.stage_seconds.end(), 0.0);
  };
  const double before = counted();
  const auto start = Clock::now();
  work();
  const std::chrono::duration<double> seconds = Clock::now() - start;
  const double within = counted() - before;
  report.stage_seconds[static_cast<std::size_t>(stage)] += std::max(0.0, seconds.count() - within);
}

/// The worse of two: the enumerators are in order of severity.
inline void worsen(StepReport& report, Status status) {
  report.status = std::max(report.status, status);
}

}  // namespace weft
