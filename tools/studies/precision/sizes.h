/// Cost against size: `hang` at 1 % from 20 x 20 to 1000 x 1000, every solver.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

struct SizePoint {
  int size = 0;
  int substeps = 1;
  Outcome outcome;
};

/// The cheapest number of substeps at each size. A curve ends where a run is out of time, or would
/// be by the exponent so far.
struct SizeCurve {
  std::string solver;
  std::vector<SizePoint> points;   ///< those that count
  std::string end;                 ///< why there are no larger ones; empty at the largest
  std::optional<double> exponent;  ///< of the time per frame over the number of particles
};

struct SizeStudy {
  std::string scene = "hang";
  double tolerance = 0.01;
  int frames = 50;
  int threads = 0;            ///< 0: all
  double seconds_limit = 45;  ///< of processor time, all threads together
  std::vector<int> sizes;
  std::vector<SizeCurve> curves;
};

/// By the points that the curve has.
std::optional<double> exponent(const SizeCurve& curve);

/// quick: up to 60 x 60, and less time.
SizeStudy size_study(bool quick);

/// Called before every run.
using SizeWatch = std::function<void(const std::string&)>;

Result<void> measure(SizeStudy& study, const SizeWatch& watch);

}  // namespace weft::tools::precision
