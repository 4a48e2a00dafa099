#include "engine/mesh/families.h"

#include <utility>

namespace weft::mesh {
namespace {

constexpr std::uint32_t kUnknown = 2;

/// Numbers the first family that it meets 0; returns the quads that it reached.
std::vector<std::uint32_t> spread(std::uint32_t start, const std::vector<Face>& faces,
                                  const Edges& edges, double weld_distance,
                                  std::vector<std::uint32_t>& first_side) {
  std::vector<std::uint32_t> reached{start};
  first_side[start] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::uint32_t face = reached[i];
    for (std::uint32_t side = 0; side < 4; ++side) {
      if (is_seam(edges.at(face, side), faces, weld_distance)) continue;
      for (const auto& [other, other_side] : edges.at(face, side).faces) {
        if (!faces[other].is_quad() || first_side[other] != kUnknown) continue;
        first_side[other] = (first_side[face] + side + other_side) % 2;
        reached.push_back(other);
      }
    }
  }
  return reached;
}

/// How far each family runs along an axis.
std::pair<double, double> run(double Vec3::*axis, const std::vector<std::uint32_t>& quads,
                              const std::vector<Face>& faces,
                              const std::vector<std::uint32_t>& first_side) {
  double sums[2] = {0, 0};
  for (const std::uint32_t face : quads) {
    for (std::uint32_t side = 0; side < 4; ++side) {
      sums[(side + first_side[face]) % 2] += std::abs(side_vector(faces[face], side).*axis);
    }
  }
  return {sums[0], sums[1]};
}

/// The difference that rounding makes of equal sums.
constexpr double kAlike = 1e-6;

bool second_is_warp(const std::vector<std::uint32_t>& quads, const std::vector<Face>& faces,
                    const std::vector<std::uint32_t>& first_side) {
  for (const auto axis : {&Vec3::y, &Vec3::x}) {
    const auto [first, second] = run(axis, quads, faces, first_side);
    if (std::abs(first - second) > kAlike * (first + second)) return second > first;
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> warp_sides(const std::vector<Face>& faces, const Edges& edges,
                                      double weld_distance) {
  std::vector<std::uint32_t> first_side(faces.size(), kUnknown);
  for (std::uint32_t face = 0; face < faces.size(); ++face) {
    if (!faces[face].is_quad() || first_side[face] != kUnknown) continue;
    const auto quads = spread(face, faces, edges, weld_distance, first_side);
    if (!second_is_warp(quads, faces, first_side)) continue;
    for (const std::uint32_t quad : quads) first_side[quad] ^= 1;
  }
  for (std::uint32_t& side : first_side) side %= kUnknown;
  return first_side;
}

}  // namespace weft::mesh
