#include "engine/model/unevenness.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/partition.h"

namespace weft {
namespace {

struct Part {
  double least = std::numeric_limits<double>::infinity(), most = 0;  // inverse mass
  double length = 0;
  double constraints = 0;
};

}  // namespace

Unevenness find_unevenness(std::span<const double> inverse_mass, std::span<const std::uint32_t> a,
                           std::span<const std::uint32_t> b, std::span<const double> rest_length) {
  const auto is_free = [&](std::uint32_t particle) { return inverse_mass[particle] > 0; };
  Partition parts(inverse_mass.size());
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (is_free(a[c]) && is_free(b[c])) parts.join(a[c], b[c]);
  }
  std::vector<Part> sums(inverse_mass.size());
  for (std::size_t c = 0; c < a.size(); ++c) {
    for (const std::uint32_t end : {a[c], b[c]}) {
      if (!is_free(end)) continue;
      Part& part = sums[parts.first(end)];
      part.least = std::min(part.least, inverse_mass[end]);
      part.most = std::max(part.most, inverse_mass[end]);
      part.length += rest_length[c];
      ++part.constraints;
    }
  }
  Unevenness uneven;
  for (const Part& part : sums) {
    if (part.constraints == 0) continue;
    const double ratio = part.most / part.least, mean = part.length / part.constraints;
    uneven.ratio = std::max(uneven.ratio, ratio);
    uneven.per_metre = std::max(uneven.per_metre, ratio / mean);
    uneven.lightness = std::max(uneven.lightness, part.most);
    uneven.lightness_per_metre = std::max(uneven.lightness_per_metre, part.most / mean);
  }
  return uneven;
}

}  // namespace weft
