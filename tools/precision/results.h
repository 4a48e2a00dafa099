/// What `weft precision` measured.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/precision/order.h"
#include "tools/precision/sizes.h"
#include "tools/precision/task.h"

namespace weft::tools::precision {

/// One scene: weft's points and those of peers.
struct Chart {
  Task task;
  std::vector<Point> points;
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
/// In the order of first appearance.
std::vector<std::string> contenders(const Chart& chart);

/// The cheapest point of a contender that counts and keeps max_strain within the bound.
const Point* cheapest(const Chart& chart, const std::string& contender, double bound);

}  // namespace weft::tools::precision
