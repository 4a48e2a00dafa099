/// What `weft precision` measured.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/studies/precision/motion.h"
#include "tools/studies/precision/order.h"
#include "tools/studies/precision/sizes.h"
#include "tools/studies/precision/sweep.h"
#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

/// One scene: weft's points and those of peers.
struct Chart {
  Task task;
  std::vector<Point> points;
  std::vector<MotionPoint> motion;                ///< asked for and got
  double seconds_limit = Effort{}.seconds_limit;  ///< that a run was cut at
  std::map<std::string, double> tightest;         ///< strain that a contender's sweep aims at

  /// No run that was cut takes less than this per frame. (Processor time is at most that of all
  /// threads together.)
  double ms_limit() const { return 1000 * seconds_limit / task.frames / task.threads; }
};

struct Study {
  bool quick = false;
  std::string bullet;  ///< its version; empty: not built in
  std::vector<Chart> charts;
  std::vector<Order> orders;
  std::optional<SizeStudy> sizes;
};

/// Strains for which the cheapest settings are sought.
inline constexpr std::array<double, 5> kBounds{0.1, 0.01, 1e-3, 1e-4, 1e-5};

/// "original" for the paper's unoptimised method, else the solver or the peer.
std::string contender(const Point& point);
std::string contender(const Settings& settings);
bool is_peer(const Point& point);
/// In the order of first appearance.
std::vector<std::string> contenders(const Chart& chart);

/// The cheapest point of a contender that counts and keeps max_strain within the bound.
const Point* cheapest(const Chart& chart, const std::string& contender, double bound);

/// Notes the tolerances that a curve was measured at; fixed iterations aim at no strain.
void note_aims(Chart& chart, const Curve& curve);

/// Why there is no cheapest point.
/// not_aimed_at: no setting of the sweep aims at so small a strain.
/// out_of_time: some were cut at the limit of time, and so were not seen to fail.
/// failed: all that aim at it ran, and missed it or gained energy.
enum class Gap { not_aimed_at, out_of_time, failed };
Gap gap(const Chart& chart, const std::string& contender, double bound);

}  // namespace weft::tools::precision
