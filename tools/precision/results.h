/// What `weft precision` measured, and the forms in which it is written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/json_output.h"
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

/// "original" for the paper's unoptimised method, else the solver or the peer.
std::string contender(const Point& point);

/// The cheapest point of a contender that counts and keeps max_strain within the bound.
const Point* cheapest(const Chart& chart, const std::string& contender, double bound);

Json to_json(const Study& study);
std::string points_csv(const Study& study);
std::string sizes_csv(const SizeStudy& study);

/// For a reader: the cheapest way to each bound, the orders, cost against size, and what failed.
std::string to_text(const Study& study);

}  // namespace weft::tools::precision
