#include "engine/model/pressures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "engine/partition.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;
using DirectedSide = std::pair<std::uint32_t, std::uint32_t>;

std::vector<DirectedSide> sorted_sides(std::span<const SurfaceTriangle> triangles, bool turned) {
  std::vector<DirectedSide> sides;
  sides.reserve(3 * triangles.size());
  for (const SurfaceTriangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      sides.push_back(turned ? DirectedSide{to, from} : DirectedSide{from, to});
    }
  }
  std::ranges::sort(sides);
  return sides;
}

Result<void> validate_listed(const std::string& field, const Pressure& part, std::size_t count) {
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    if (part.triangles[k] < count) continue;
    return refuse(element(field + ".triangles", k),
                  "no such triangle, the surface has " + std::to_string(count),
                  std::to_string(part.triangles[k]));
  }
  std::vector<std::uint32_t> sorted = part.triangles;
  std::ranges::sort(sorted);
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice == sorted.end()) return {};
  return refuse(field + ".triangles", "lists a triangle twice", std::to_string(*twice));
}

Result<void> validate_closed(const std::string& field, std::span<const SurfaceTriangle> triangles) {
  const auto border = find_border(triangles);
  if (!border) return {};
  return refuse(
      field + ".gas", "its triangles do not close, a side is of one alone",
      "particles " + std::to_string(border->first) + ", " + std::to_string(border->second));
}

/// has_closed: these triangles are known to.
Result<void> validate_gas(const std::string& field, const Pressure& part, bool has_closed,
                          std::span<const SurfaceTriangle> surface, const SlotPlace& place) {
  if (auto r = validate_positive(field + ".ambient", part.ambient); !r) return r;
  if (!(part.ambient + part.pressure > 0))
    return refuse(field + ".pressure", "a gas has more than none: must be above -ambient",
                  number(part.pressure));
  if (auto r = validate_not_negative(field + ".volume", part.volume); !r) return r;
  const std::vector<SurfaceTriangle> triangles = triangles_of(part, surface);
  if (!has_closed) {
    if (auto r = validate_closed(field, triangles); !r) return r;
  }
  const double volume = enclosed_volume(triangles, place);
  if (part.volume > 0 ? volume >= 0 : volume > 0) return {};
  return refuse(field + ".gas", "its normals must point out of the volume that it fills, in m^3",
                number(volume));
}

}  // namespace

std::vector<SurfaceTriangle> triangles_of(const Pressure& part,
                                          std::span<const SurfaceTriangle> surface) {
  std::vector<SurfaceTriangle> triangles;
  for_each_triangle(part, surface, [&](const SurfaceTriangle& t) { triangles.push_back(t); });
  return triangles;
}

std::optional<DirectedSide> find_border(std::span<const SurfaceTriangle> triangles) {
  const std::vector<DirectedSide> there = sorted_sides(triangles, false),
                                  back = sorted_sides(triangles, true);
  const auto [one, other] = std::ranges::mismatch(there, back);
  if (one == there.end()) return std::nullopt;
  return *one < *other ? *one : DirectedSide{other->second, other->first};
}

double enclosed_volume(std::span<const SurfaceTriangle> triangles, const SlotPlace& place) {
  if (triangles.empty()) return 0;
  const Vector origin = place(triangles.front()[0]);
  double volume = 0;
  for (const auto& [a, b, c] : triangles)
    volume += dot(place(a) - origin, cross(place(b) - origin, place(c) - origin)) / 6;
  return volume;
}

AirPieces find_air_pieces(std::span<const SurfaceTriangle> triangles) {
  std::uint32_t corners = 0;
  for (const SurfaceTriangle& t : triangles)
    corners = std::max({corners, t[0] + 1, t[1] + 1, t[2] + 1});
  Partition joined(corners);
  for (const SurfaceTriangle& t : triangles) {
    for (const std::uint32_t other : {t[1], t[2]}) joined.join(t[0], other);
  }
  AirPieces pieces;
  std::map<std::uint32_t, std::uint32_t> piece_of_first;
  std::vector<std::vector<SurfaceTriangle>> of_piece;
  for (const SurfaceTriangle& t : triangles) {
    const auto next = static_cast<std::uint32_t>(piece_of_first.size());
    const std::uint32_t piece = piece_of_first.try_emplace(joined.first(t[0]), next).first->second;
    if (piece == of_piece.size()) of_piece.emplace_back();
    of_piece[piece].push_back(t);
    pieces.of.push_back(piece);
  }
  for (const auto& each : of_piece) pieces.is_open.push_back(find_border(each).has_value());
  return pieces;
}

std::vector<Pressure> with_volumes(std::span<const Pressure> pressures,
                                   std::span<const SurfaceTriangle> surface,
                                   const SlotPlace& place) {
  std::vector<Pressure> known(pressures.begin(), pressures.end());
  for (Pressure& part : known) {
    if (part.gas && part.volume == 0)
      part.volume = enclosed_volume(triangles_of(part, surface), place);
  }
  return known;
}

void let_gas_out(std::vector<Pressure>& pressures, std::span<const SurfaceTriangle> surface) {
  for (Pressure& part : pressures) {
    if (part.gas && find_border(triangles_of(part, surface)))
      part = {.triangles = std::move(part.triangles)};
  }
}

Result<void> validate_pressures(std::span<const Pressure> pressures,
                                std::span<const Pressure> known,
                                std::span<const SurfaceTriangle> surface, const SlotPlace& place) {
  for (std::size_t i = 0; i < pressures.size(); ++i) {
    const Pressure& part = pressures[i];
    const std::string field = element("pressures", i);
    const bool is_known = i < known.size() && known[i].triangles == part.triangles;
    if (!(std::abs(part.pressure) <= kMostSquared))
      return refuse(field + ".pressure", "must be finite", number(part.pressure));
    if (surface.empty())
      return refuse(field, "needs the triangles of `surface`", number(part.pressure));
    if (!is_known) {
      if (auto r = validate_listed(field, part, surface.size()); !r) return r;
    }
    if (!part.gas) continue;
    const bool has_closed = is_known && known[i].gas;
    if (auto r = validate_gas(field, part, has_closed, surface, place); !r) return r;
  }
  return {};
}

}  // namespace weft
