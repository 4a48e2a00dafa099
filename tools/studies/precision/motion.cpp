#include "tools/studies/precision/motion.h"

#include <fmt/format.h>

namespace weft::tools::precision {

Result<std::vector<MotionPoint>> measure_motion(const Task& task, const Watch& watch) {
  Task until = task;
  until.frames = kReferenceFrame;
  std::vector<MotionPoint> points;
  for (const double tolerance : {0., 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4}) {
    watch(fmt::format("motion, {:g} m/s", tolerance));
    Settings settings;
    settings.solver = Solver::small_steps;
    settings.motion_tolerance = tolerance;
    settings.threads = task.threads;
    const auto point = measure(until, settings, {.repeat = 3});
    if (!point) return Error{point.error()};
    const Outcome& outcome = point.value().outcome;
    if (!outcome.is_complete() || !outcome.trajectory_error) continue;
    points.push_back({tolerance, *outcome.trajectory_error / (kFrame * kReferenceFrame),
                      outcome.motion_error, outcome.substeps, outcome.ms_per_frame});
  }
  return points;
}

}  // namespace weft::tools::precision
