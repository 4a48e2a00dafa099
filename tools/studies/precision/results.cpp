#include "tools/studies/precision/results.h"

#include <algorithm>

namespace weft::tools::precision {
namespace {

/// A strain that is a hair above its bound by rounding alone is within it.
constexpr double kRounding = 1 + 1e-6;

}  // namespace

std::string contender(const Point& point) {
  return point.backend == name(Backend::reference) ? "original" : point.solver;
}

bool is_peer(const Point& point) { return point.backend.empty(); }

std::string contender(const Settings& settings) {
  return settings.backend == Backend::reference ? "original" : std::string(name(settings.solver));
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

void note_aims(Chart& chart, const Curve& curve) {
  for (const Row& row : curve.rows) {
    for (const Settings& settings : row) {
      if (settings.iterations > 0) continue;
      const double aim = settings.tolerance;
      double& tightest = chart.tightest.try_emplace(contender(settings), aim).first->second;
      tightest = std::min(tightest, aim);
    }
  }
}

/// A row of a sweep ends with the run that is cut: whatever that one aimed at, tighter ones were
/// then not tried.
Gap gap(const Chart& chart, const std::string& name, double bound) {
  const auto aim = chart.tightest.find(name);
  if (aim == chart.tightest.end() || aim->second > bound * kRounding) return Gap::not_aimed_at;
  const bool was_cut = std::ranges::any_of(chart.points, [&](const Point& point) {
    const bool aims = point.knobs.tolerance || is_peer(point);
    return contender(point) == name && aims && point.outcome.status == "out_of_time";
  });
  return was_cut ? Gap::out_of_time : Gap::failed;
}

}  // namespace weft::tools::precision
