#include "engine/surface/nearest_triangle.h"

#include <algorithm>
#include <limits>

#include "engine/geometry.h"

namespace weft::surface {
namespace {

using namespace mesh;

constexpr std::uint32_t kMostInLeaf = 4;
/// Distances that differ by less than this fraction of the distance and of the triangle's size are
/// one distance, rounded.
constexpr double kRounding = 1e-9;

/// Where the place is, seen along the normal of the triangle.
Shares in_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 place) {
  const Vec3 normal = area_vector(a, b, c);
  const double square = dot(normal, normal);
  const double of_b = dot(cross(place - a, c - a), normal) / square;
  const double of_c = dot(cross(b - a, place - a), normal) / square;
  return {1 - of_b - of_c, of_b, of_c};
}

/// The share of b in the nearest point between a and b.
double on_edge(Vec3 a, Vec3 b, Vec3 place) {
  return std::clamp(dot(place - a, b - a) / dot(b - a, b - a), 0., 1.);
}

Vec3 place_of(const std::array<Vec3, 3>& corners, const Shares& shares) {
  return shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2];
}

double component(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double distance_to_box(Vec3 least, Vec3 most, Vec3 p) {
  const auto beside = [](double low, double high, double x) {
    return std::max({low - x, x - high, 0.});
  };
  return length(
      {beside(least.x, most.x, p.x), beside(least.y, most.y, p.y), beside(least.z, most.z, p.z)});
}

}  // namespace

struct NearestTriangle::Search {
  Vec3 place{};
  Nearest best{.distance = std::numeric_limits<double>::infinity()};
  double inside = 0;  // the least share of the place in the plane of the best
  double slack = 0;   // m, that distances may differ by for no reason
};

NearestTriangle::NearestTriangle(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles), centres_(triangles.size()) {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    if (!has_area(points[a], points[b], points[c])) continue;
    centres_[t] = (1. / 3) * (points[a] + points[b] + points[c]);
    order_.push_back(t);
  }
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

void NearestTriangle::bound(Node& node) const {
  node.least = node.most = points_[triangles_[order_[node.first]][0]];
  for (std::uint32_t i = 0; i < node.count; ++i) {
    for (const std::uint32_t corner : triangles_[order_[node.first + i]]) {
      const Vec3 p = points_[corner];
      node.least = {std::min(node.least.x, p.x), std::min(node.least.y, p.y),
                    std::min(node.least.z, p.z)};
      node.most = {std::max(node.most.x, p.x), std::max(node.most.y, p.y),
                   std::max(node.most.z, p.z)};
    }
  }
}

void NearestTriangle::build(std::uint32_t first, std::uint32_t count) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({.first = first, .count = count});
  bound(nodes_[number]);
  if (count <= kMostInLeaf) return;
  const Vec3 size = nodes_[number].most - nodes_[number].least;
  const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::ranges::nth_element(begin, begin + half, begin + count, {}, [&](std::uint32_t triangle) {
    return component(centres_[triangle], axis);
  });
  nodes_[number].count = 0;
  build(first, half);
  nodes_[number].other = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half);
}

void NearestTriangle::look_at(std::uint32_t triangle, Search& search) const {
  const auto [a, b, c] = triangles_[triangle];
  const std::array corners{points_[a], points_[b], points_[c]};
  const Shares plane = in_plane(corners[0], corners[1], corners[2], search.place);
  const double inside = std::ranges::min(plane);
  const auto consider = [&](const Shares& shares) {
    const double distance = length(search.place - place_of(corners, shares));
    const double slack = kRounding * (distance + length(corners[1] - corners[0]));
    const bool is_as_near = distance <= search.best.distance + slack && inside > search.inside;
    if (distance >= search.best.distance - slack && !is_as_near) return;
    search.best = {triangle, shares, distance};
    search.inside = inside;
    search.slack = slack;
  };
  if (inside >= 0) return consider(plane);
  Shares nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    Shares shares{};
    shares[next] = on_edge(corners[i], corners[next], search.place);
    shares[i] = 1 - shares[next];
    const double distance = length(search.place - place_of(corners, shares));
    if (distance < least) {
      least = distance;
      nearest = shares;
    }
  }
  consider(nearest);
}

void NearestTriangle::visit(std::uint32_t number, Search& search) const {
  const Node& node = nodes_[number];
  const auto far = [&](const Node& of) {
    return distance_to_box(of.least, of.most, search.place) > search.best.distance + search.slack;
  };
  if (far(node)) return;
  for (std::uint32_t i = 0; i < node.count; ++i) look_at(order_[node.first + i], search);
  if (node.count > 0) return;
  const auto distance = [&](std::uint32_t child) {
    return distance_to_box(nodes_[child].least, nodes_[child].most, search.place);
  };
  std::uint32_t near = number + 1, other = node.other;
  if (distance(other) < distance(near)) std::swap(near, other);
  visit(near, search);
  visit(other, search);
}

Nearest NearestTriangle::operator()(Vec3 place) const {
  Search search{.place = place};
  if (!is_empty()) visit(0, search);
  return search.best;
}

}  // namespace weft::surface
