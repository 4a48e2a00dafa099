/// What of the error of motion is asked for, got and estimated, and what it costs.
#pragma once

#include <weft/weft.h>

#include <vector>

#include "tools/studies/precision/sweep.h"
#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

/// Of a run until kReferenceFrame.
struct MotionPoint {
  double asked = 0;      ///< m/s, Settings::motion_tolerance; 0: not asked for
  double got = 0;        ///< m/s, the largest distance from the true motion over time
  double estimated = 0;  ///< m/s, StepReport::motion_error, mean over the frames
  double substeps = 0;   ///< per frame, mean
  double ms_per_frame = 0;
};

/// At 1 %, by small steps, from loose to tight; first without. Of a task with its reference; runs
/// that miss their tolerance are left out.
Result<std::vector<MotionPoint>> measure_motion(const Task& task, const Watch& watch);

}  // namespace weft::tools::precision
