/// Features of surfaces, and pairs of them that may touch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

enum class PairKind : std::uint8_t { point_triangle, edges };

/// A feature of the surface a and one of the surface b, by their numbers there. The point of a
/// point and a triangle comes first. Its four points are those of the first feature, then those of
/// the second.
struct Pair {
  std::uint32_t first = 0, second = 0;
  std::uint16_t a = 0, b = 0;
  PairKind kind = PairKind::edges;

  bool operator==(const Pair&) const = default;
  /// The point is of the surface that comes later, the triangle of the one before.
  bool is_turned() const { return a > b; }
  /// 1 where a vector from the second feature to the first leads away from the later surface, else
  /// -1.
  double outward() const { return is_turned() ? -1 : 1; }
};

/// Pairs in blocks of lanes: of one kind of kernel, points beside triangles or edges.
struct PairList {
  std::vector<Pair> pairs;
  kernels::AlignedVector<simd::PairBlock> blocks;

  void clear() {
    pairs.clear();
    blocks.clear();
  }
  std::size_t size() const { return pairs.size(); }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    const std::size_t lane = pairs.size() % kernels::kLanes;
    if (lane == 0) blocks.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      // Lanes that are not used yet repeat this one.
      for (std::size_t i = lane; i < (lane == 0 ? kernels::kLanes : lane + 1); ++i)
        blocks.back().point[k][i] = points[k];
    }
    pairs.push_back(pair);
  }
  std::array<std::uint32_t, 4> points(std::size_t i) const {
    const simd::PairBlock& block = blocks[i / kernels::kLanes];
    const std::size_t lane = i % kernels::kLanes;
    return {block.point[0][lane], block.point[1][lane], block.point[2][lane], block.point[3][lane]};
  }
  std::size_t bytes() const {
    return pairs.capacity() * sizeof(Pair) + blocks.capacity() * sizeof(simd::PairBlock);
  }
};

/// Lists of pairs: points beside triangles, and edges.
inline constexpr std::size_t kPairLists = 2;
inline constexpr bool has_edges(std::size_t list) { return list == 1; }
inline constexpr std::size_t list_of(PairKind kind) { return kind == PairKind::edges ? 1 : 0; }

}  // namespace weft
