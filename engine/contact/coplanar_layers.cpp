#include "engine/contact/coplanar_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;
using kernels::Vectors;

namespace {

using PlacedTriangle = std::array<Vector, 3>;

PlacedTriangle corners_at(const TriangleSurface& cloth, std::uint32_t triangle, const Vectors& x) {
  const auto [a, b, c] = cloth.triangles[triangle];
  return {x[a], x[b], x[c]};
}

/// A unit vector, or 0 where it has no area.
Vector unit_front(const PlacedTriangle& t) {
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  return kernels::direction(n, length(n));
}

/// Whether a line in the plane across n has one on one side and the other one, farther than
/// `within`, on the other side.
bool are_apart(const PlacedTriangle& one, const PlacedTriangle& other, Vector n, double within) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector across = cross(n, one[(k + 1) % 3] - one[k]);
    double low = std::numeric_limits<double>::infinity(), high = -low, most = -low, least = low;
    for (std::size_t i = 0; i < 3; ++i) {
      const double mine = dot(across, one[i] - one[0]), its = dot(across, other[i] - one[0]);
      low = std::min(low, mine);
      high = std::max(high, mine);
      least = std::min(least, its);
      most = std::max(most, its);
    }
    const double reach = within * length(across);
    if (least > high + reach || most < low - reach) return true;
  }
  return false;
}

bool lie_in_one_plane(const PlacedTriangle& one, const PlacedTriangle& other, double within) {
  const Vector n = unit_front(one);
  const bool is_in_plane = std::ranges::all_of(
      other, [&](Vector place) { return std::abs(dot(n, place - one[0])) <= tuning::kTouching; });
  return is_in_plane && dot(n, n) > 0 && !are_apart(one, other, n, within) &&
         !are_apart(other, one, n, within);
}

bool have_common_corner(const TriangleSurface::Triangle& a, const TriangleSurface::Triangle& b) {
  return std::ranges::any_of(
      a, [&](std::uint32_t corner) { return std::ranges::find(b, corner) != b.end(); });
}

/// All that is nearer to it than half of that.
Box box_within(const PlacedTriangle& points, Vector origin, double within) {
  Box box = Box::none();
  for (const Vector place : points) {
    const Vector d = place - origin;
    const double beyond = 0.5 * within + 1e-6 * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    box.add(Box::at(d - Vector{beyond, beyond, beyond}));
    box.add(Box::at(d + Vector{beyond, beyond, beyond}));
  }
  return box;
}

}  // namespace

bool CoplanarLayers::find(const Model& model, const simd::Table& table, const Vectors& x) {
  const TriangleSurface& cloth = model.touched_surface();
  const double within = model.self_contact.thickness;
  if (tree_.empty()) tree_ = BoxTree(cloth.in_order);
  const Vector origin = cloth.triangles.empty() ? Vector{} : x[cloth.triangles[0][0]];
  tree_.refit([&](std::uint32_t t) { return box_within(corners_at(cloth, t, x), origin, within); });
  met_.clear();
  BoxTree::meet_itself(table, tree_, [&](std::uint32_t a, std::uint32_t b) {
    if (!cloth.is_face(a) || !cloth.is_face(b)) return;
    if (have_common_corner(cloth.triangles[a], cloth.triangles[b])) return;
    if (lie_in_one_plane(corners_at(cloth, a, x), corners_at(cloth, b, x), within))
      met_.push_back({std::max(a, b), std::min(a, b)});
  });
  if (met_.empty()) return false;
  find_places(cloth, x);
  std::erase_if(met_, [&](const Over& met) {
    return of_[met[0]].piece == of_[met[1]].piece && of_[met[0]].layer == of_[met[1]].layer;
  });
  return !met_.empty();
}

/// From one triangle over edges to all that takes(from, to); joined(from, to) when one is reached.
template <class Takes, class Joined>
void CoplanarLayers::flood(const TriangleSurface& cloth, std::uint32_t first, Takes&& takes,
                           Joined&& joined) {
  to_visit_.assign(1, first);
  while (!to_visit_.empty()) {
    const std::uint32_t from = to_visit_.back();
    to_visit_.pop_back();
    const TriangleSurface::Triangle& corners = cloth.triangles[from];
    for (std::size_t k = 0; k < 3; ++k) {
      for (const std::uint32_t to : cloth.triangles_at[corners[k]]) {
        const TriangleSurface::Triangle& its = cloth.triangles[to];
        const bool has_edge = std::ranges::find(its, corners[(k + 1) % 3]) != its.end();
        if (!has_edge || !takes(from, to)) continue;
        joined(from, to);
        to_visit_.push_back(to);
      }
    }
  }
}

void CoplanarLayers::find_places(const TriangleSurface& cloth, const Vectors& x) {
  const auto count = static_cast<std::uint32_t>(cloth.triangles.size());
  const auto front = [&](std::uint32_t t) { return unit_front(corners_at(cloth, t, x)); };
  of_.assign(count, {kNoIndex, kNoIndex, false});
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!cloth.is_face(t) || of_[t].layer != kNoIndex) continue;
    of_[t].layer = t;
    flood(
        cloth, t,
        [&](std::uint32_t from, std::uint32_t to) {
          return of_[to].layer == kNoIndex && dot(front(from), front(to)) >= 0;
        },
        [&](std::uint32_t, std::uint32_t to) { of_[to].layer = t; });
  }
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!cloth.is_face(t) || of_[t].piece != kNoIndex) continue;
    of_[t].piece = t;
    flood(
        cloth, t, [&](std::uint32_t, std::uint32_t to) { return of_[to].piece == kNoIndex; },
        [&](std::uint32_t from, std::uint32_t to) {
          const bool is_folded = of_[from].layer != of_[to].layer;
          of_[to].piece = t;
          of_[to].is_turned = of_[from].is_turned != is_folded;
        });
  }
}

/// The later of two that lie over each other has a higher rank.
void CoplanarLayers::rank(std::vector<Over>& over, std::vector<std::uint32_t>& ranks) {
  std::ranges::sort(over);
  for (const auto& [later, earlier] : over)
    ranks[later] = std::max(ranks[later], ranks[earlier] + 1);
}

void CoplanarLayers::rank_all(std::size_t triangles) {
  pieces_.clear();
  layers_.clear();
  for (const auto& [a, b] : met_) {
    const Place &one = of_[a], &other = of_[b];
    if (one.piece != other.piece)
      pieces_.push_back({std::max(one.piece, other.piece), std::min(one.piece, other.piece)});
    else
      layers_.push_back({std::max(one.layer, other.layer), std::min(one.layer, other.layer)});
  }
  piece_rank_.assign(triangles, 0);
  layer_rank_.assign(triangles, 0);
  rank(pieces_, piece_rank_);
  rank(layers_, layer_rank_);
}

void CoplanarLayers::part(const Model& model, Vectors& x) {
  const TriangleSurface& cloth = model.touched_surface();
  rank_all(cloth.triangles.size());
  const double layers = 1 + 2.0 * *std::ranges::max_element(layer_rank_);
  const auto way = [&](std::uint32_t t) {
    const Place& place = of_[t];
    const double of_piece = layers * piece_rank_[place.piece], of_layer = layer_rank_[place.layer];
    return ((place.is_turned ? -of_piece : of_piece) + of_layer) *
           unit_front(corners_at(cloth, t, x));
  };
  ways_.assign(model.slots(), Vector{});
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (model.inverse_mass[slot] == 0) continue;
    double count = 0;
    for (const std::uint32_t t : cloth.triangles_at[slot]) {
      if (!cloth.is_face(t)) continue;
      ways_[slot] = ways_[slot] + way(t);
      ++count;
    }
    if (count > 0) ways_[slot] = (tuning::kCoplanarWay / count) * ways_[slot];
  }
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) x.set(slot, x[slot] + ways_[slot]);
}

std::size_t CoplanarLayers::bytes() const {
  return tree_.bytes() + bytes_of(met_) + bytes_of(of_) + bytes_of(to_visit_) + bytes_of(pieces_) +
         bytes_of(layers_) + bytes_of(piece_rank_) + bytes_of(layer_rank_) + bytes_of(ways_);
}

}  // namespace weft
