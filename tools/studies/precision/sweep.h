/// weft's own curves: every solver with every scheme that it takes, each turning its own knobs.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <string>
#include <vector>

#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

/// Settings in the order of rising cost. A row ends at the first run that is out of time.
using Row = std::vector<Settings>;

/// One solver and scheme: for each number of substeps a row of tolerances, and for each a row of
/// fixed iterations.
struct Curve {
  std::string label;
  std::vector<Row> rows;
};

/// The paper's unoptimised method first, then the simd backend: each method once, of automatic the
/// plain call alone. quick: fewer knobs.
std::vector<Curve> weft_curves(const Task& task, bool quick);

/// The fastest of several runs. An error: the settings were refused.
Result<Point> measure(const Task& task, const Settings& settings, const Effort& effort);

/// Called before every run with what it is.
using Watch = std::function<void(const std::string&)>;

Result<std::vector<Point>> sweep(const Task& task, const Curve& curve, const Effort& effort,
                                 const Watch& watch);

}  // namespace weft::tools::precision
