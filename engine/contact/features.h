/// Pairs of features of the cloth and of a body that is a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

/// Which features a pair has. Its four points are those of the first, then those of the second.
enum class PairKind : std::uint8_t {
  particle_triangle,  ///< a particle of the cloth, a triangle of the body
  vertex_triangle,    ///< a vertex of the body, a triangle of the cloth
  edges               ///< an edge of the cloth, an edge of the body
};

/// The numbers of its features are those of their surfaces.
struct Pair {
  std::uint32_t of_cloth = 0, of_body = 0;
  std::uint16_t mesh = 0;  // its place among the meshes
  PairKind kind = PairKind::edges;

  bool operator==(const Pair&) const = default;
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
