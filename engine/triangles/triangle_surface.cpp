#include "engine/triangles/triangle_surface.h"

#include <weft/result.h>
#include <weft/scene.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// A side of a triangle, its lower point first.
struct Side {
  std::uint32_t a = 0, b = 0, triangle = 0, k = 0;
};

std::vector<Side> sides_of(std::span<const TriangleSurface::Triangle> triangles) {
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      if (a != b) sides.push_back({a, b, t, k});
    }
  }
  std::ranges::sort(sides, [](const Side& l, const Side& r) {
    return std::array{l.a, l.b, l.triangle, l.k} < std::array{r.a, r.b, r.triangle, r.k};
  });
  return sides;
}

void join_sides(TriangleSurface& s) {
  s.edges_of.assign(s.triangles.size(), {kNoIndex, kNoIndex, kNoIndex});
  const std::vector<Side> sides = sides_of(s.triangles);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    if (i == 0 || side.a != sides[i - 1].a || side.b != sides[i - 1].b) {
      s.edges.push_back({side.a, side.b});
      s.opposite.push_back({kNoIndex, kNoIndex});
      s.owns[side.triangle] = static_cast<std::uint8_t>(s.owns[side.triangle] | 8u << side.k);
    }
    const auto edge = static_cast<std::uint32_t>(s.edges.size() - 1);
    if (s.is_thread(side.triangle)) {
      s.edges_of[side.triangle] = {edge, edge, edge};
      continue;
    }
    s.edges_of[side.triangle][side.k] = edge;
    auto& opposite = s.opposite.back();
    const std::uint32_t third = s.triangles[side.triangle][(side.k + 2) % 3];
    if (opposite[0] == kNoIndex)
      opposite[0] = third;
    else if (opposite[1] == kNoIndex)
      opposite[1] = third;
  }
}

void own_corners(TriangleSurface& s, std::size_t points) {
  std::vector<bool> is_owned(points);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = s.triangles[t][k];
      if (is_owned[p]) continue;
      is_owned[p] = true;
      s.owns[t] = static_cast<std::uint8_t>(s.owns[t] | 1u << k);
    }
  }
}

/// 21 bits of x, two places apart from each other.
std::uint64_t spread(std::uint64_t x) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 21; ++i) bits |= (x >> i & 1) << (3 * i);
  return bits;
}

/// Along a curve that fills space (Morton, 1966).
std::vector<std::uint32_t> along_curve(const TriangleSurface& s,
                                       std::span<const std::array<double, 3>> places) {
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const TriangleSurface::Triangle& t : s.triangles) {
    for (const std::uint32_t p : t) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], places[p][k]);
        high[k] = std::max(high[k], places[p][k]);
      }
    }
  }
  const double widest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double scale = widest > 0 ? ((1 << 21) - 1) / (3 * widest) : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    std::uint64_t key = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      double sum = 0;
      for (const std::uint32_t p : s.triangles[t]) sum += places[p][k] - low[k];
      const double at = scale * sum;
      const bool is_number = at >= 0 && at < (1 << 21);  // places may be as far apart as numbers go
      key |= spread(is_number ? static_cast<std::uint64_t>(at) : 0) << k;
    }
    keys.push_back({key, t});
  }
  std::ranges::sort(keys);
  std::vector<std::uint32_t> order;
  for (const auto& [key, t] : keys) order.push_back(t);
  return order;
}

}  // namespace

TriangleSurface make_triangle_surface(std::span<const TriangleSurface::Triangle> triangles,
                                      std::span<const std::array<double, 3>> places,
                                      std::span<const std::uint32_t> loose,
                                      std::span<const std::array<std::uint32_t, 2>> threads) {
  TriangleSurface s;
  s.triangles.assign(triangles.begin(), triangles.end());
  for (const auto& [a, b] : threads) s.triangles.push_back({a, b, b});
  s.has_threads = !threads.empty();
  const std::size_t joined = s.triangles.size();
  for (const std::uint32_t p : loose) s.triangles.push_back({p, p, p});
  s.owns.resize(s.triangles.size());
  join_sides(s);
  own_corners(s, places.size());
  s.triangles_at = make_lists(places.size(), [&](auto&& add) {
    for (std::uint32_t t = 0; t < joined; ++t) {
      const auto [a, b, c] = s.triangles[t];
      add(a, t);
      add(b, t);
      if (c != b) add(c, t);
    }
  });
  s.neighbours = make_lists(places.size(), [&](auto&& add) {
    for (const auto& [a, b] : s.edges) {
      add(a, b);
      add(b, a);
    }
  });
  s.in_order = along_curve(s, places);
  return s;
}

std::size_t TriangleSurface::bytes() const {
  return bytes_of(triangles) + bytes_of(edges) + bytes_of(edges_of) + bytes_of(opposite) +
         bytes_of(owns) + triangles_at.bytes() + neighbours.bytes() + bytes_of(in_order);
}

}  // namespace weft
