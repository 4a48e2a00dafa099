#include "engine/contact/rest_lengths.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace weft {

std::vector<double> lengths_at_rest(const Model& model, const TriangleSurface& s) {
  std::vector<std::pair<std::uint64_t, double>> known;
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  };
  const ConstraintStore& c = model.constraints;
  for (std::size_t i = 0; i < c.size(); ++i)
    known.push_back({key(c.a[i], c.b[i]), c.rest_length[i]});
  model.membrane.for_each_side([&](std::uint32_t a, std::uint32_t b, double l) {
    known.push_back({key(a, b), l});
  });
  std::ranges::sort(known);
  std::vector<double> lengths;
  for (const auto& [a, b] : s.edges) {
    const auto found =
        std::ranges::lower_bound(known, key(a, b), {}, &std::pair<std::uint64_t, double>::first);
    lengths.push_back(found != known.end() && found->first == key(a, b)
                          ? found->second
                          : length(model.initial_position[a] - model.initial_position[b]));
  }
  return lengths;
}

}  // namespace weft
