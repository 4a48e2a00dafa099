#include "tools/precision/results.h"

#include <algorithm>

namespace weft::tools::precision {
namespace {

/// A strain that is a hair above its bound by rounding alone is within it.
constexpr double kRounding = 1 + 1e-6;

}  // namespace

std::string contender(const Point& point) {
  return point.backend == name(Backend::reference) ? "original" : point.solver;
}

std::vector<std::string> contenders(const Chart& chart) {
  std::vector<std::string> names;
  for (const Point& point : chart.points) {
    const std::string name = contender(point);
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

const Point* cheapest(const Chart& chart, const std::string& name, double bound) {
  const Point* best = nullptr;
  for (const Point& point : chart.points) {
    const Outcome& outcome = point.outcome;
    if (contender(point) != name || !outcome.counts()) continue;
    if (outcome.max_strain > bound * kRounding) continue;
    if (!best || outcome.ms_per_frame < best->outcome.ms_per_frame) best = &point;
  }
  return best;
}

}  // namespace weft::tools::precision
