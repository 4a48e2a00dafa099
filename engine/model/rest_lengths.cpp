#include "engine/model/rest_lengths.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace weft {
namespace {

/// m, of a triangle with these sides, by Heron's formula.
double largest_height(double a, double b, double c) {
  const double half = (a + b + c) / 2;
  const double area = std::sqrt(std::max(0.0, half * (half - a) * (half - b) * (half - c)));
  const double shortest = std::min({a, b, c});
  return shortest > 0 ? 2 * area / shortest : 0;
}

}  // namespace

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

Gaps widest_gaps(const Model& model) {
  const TriangleSurface& s = model.touched_surface();
  const std::vector<double> lengths = lengths_at_rest(model, s);
  Gaps gaps;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (s.is_point(t)) continue;
    const auto [a, b, c] = s.edges_of[t];
    const double longest = std::max({lengths[a], lengths[b], lengths[c]});
    const bool is_face = s.is_face(t);
    gaps.hole = std::max(gaps.hole, (is_face ? 2 * std::numbers::inv_sqrt3 : 1) * longest);
    // A body wider than half of a row lies on particles, unless it lies exactly along the row.
    const double row = is_face ? largest_height(lengths[a], lengths[b], lengths[c]) / 2 : longest;
    gaps.strip = std::max(gaps.strip, row);
  }
  return gaps;
}

}  // namespace weft
