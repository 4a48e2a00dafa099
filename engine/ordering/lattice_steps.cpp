#include "engine/ordering/lattice_steps.h"

#include <algorithm>
#include <map>
#include <utility>

namespace weft {
namespace {

constexpr std::size_t kMostSteps = 12;  // 24 colours; leaves room for irregular links

}  // namespace

Steps::Steps(std::span<const Cell> cells, std::span<const Link> links) : cells_(cells) {
  std::map<Step, std::size_t> count;
  for (const Link& link : links) {
    if (is_within_part(link)) ++count[step(link)];
  }
  const std::size_t least = std::max<std::size_t>(kLanes / 2, links.size() / 32);
  std::vector<std::pair<std::size_t, Step>> sorted;
  for (const auto& [step, n] : count) {
    if (n >= least) sorted.push_back({n, step});
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (sorted.size() > kMostSteps) sorted.resize(kMostSteps);
  for (const auto& [n, step] : sorted) frequent_.push_back(step);
  std::sort(frequent_.begin(), frequent_.end());
}

std::uint32_t Steps::colour_class(const Link& link) const {
  if (!is_within_part(link)) return kNoIndex;
  const Step s = step(link);
  const auto found = std::lower_bound(frequent_.begin(), frequent_.end(), s);
  if (found == frequent_.end() || *found != s) return kNoIndex;
  const Cell& from = std::min(cells_[link.a], cells_[link.b]);
  const std::int32_t step_number = s.rows > 0 ? from.row / s.rows : from.column / s.columns;
  const auto k = static_cast<std::uint32_t>(found - frequent_.begin());
  return 2 * k + (step_number % 2 != 0 ? 1 : 0);
}

Steps::Period Steps::period() const {
  Period period;
  for (const Step& s : frequent_) {
    if (s.rows == 2) period.rows = 4;
    if (s.rows == 0 && s.columns == 2) period.columns = 4;
  }
  return period;
}

Step Steps::step(const Link& link) const {
  const auto& [from, to] = std::minmax(cells_[link.a], cells_[link.b]);
  return {to.row - from.row, to.column - from.column};
}

}  // namespace weft
