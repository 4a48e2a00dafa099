/// Features of surfaces, and pairs of them that may touch.
#pragma once

#include <algorithm>
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
  /// A key of features of the cloth, which have fewer than 2^31 numbers.
  std::uint64_t key() const {
    const bool edges = kind == PairKind::edges;
    const std::uint64_t from = edges ? std::min(first, second) : first,
                        to = edges ? std::max(first, second) : second;
    return std::uint64_t{edges} << 63 | from << 32 | to;
  }
  /// Both features are of the cloth.
  constexpr bool is_within_cloth() const { return a == b; }
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
  std::vector<std::uint16_t> used;  // per block, a bit per lane: others were left out, or are not
                                    // there yet
  std::size_t left_out = 0;

  void clear() {
    pairs.clear();
    blocks.clear();
    used.clear();
    left_out = 0;
  }
  std::size_t size() const { return pairs.size(); }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    const std::size_t at = pairs.size(), lane = at % kernels::kLanes;
    if (lane == 0) {
      blocks.emplace_back();
      used.push_back(0);
    }
    pairs.emplace_back();
    put(at, pair, points);
    if (lane == 0) repeat(at);
    used.back() = static_cast<std::uint16_t>(used.back() | 1u << lane);
  }
  /// Leaves out those of which leaves_out(pair). Where most are gone the others move up: returns
  /// whether they did.
  template <class LeavesOut>
  bool leave_out(LeavesOut&& leaves_out) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!is_used(i) || !leaves_out(pairs[i])) continue;
      std::uint16_t& lanes = used[i / kernels::kLanes];
      lanes = static_cast<std::uint16_t>(lanes & ~(1u << i % kernels::kLanes));
      ++left_out;
    }
    if (2 * left_out <= pairs.size()) return false;
    move_up();
    return true;
  }
  bool is_used(std::size_t i) const {
    return (used[i / kernels::kLanes] >> i % kernels::kLanes & 1) != 0;
  }
  std::array<std::uint32_t, 4> points(std::size_t i) const {
    const simd::PairBlock& block = blocks[i / kernels::kLanes];
    const std::size_t lane = i % kernels::kLanes;
    return {block.point[0][lane], block.point[1][lane], block.point[2][lane], block.point[3][lane]};
  }
  std::size_t bytes() const {
    return pairs.capacity() * sizeof(Pair) + blocks.capacity() * sizeof(simd::PairBlock) +
           used.capacity() * sizeof(used[0]);
  }

 private:
  void put(std::size_t at, const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    pairs[at] = pair;
    for (std::size_t k = 0; k < 4; ++k)
      blocks[at / kernels::kLanes].point[k][at % kernels::kLanes] = points[k];
  }
  /// In lanes after this one, which are not used yet.
  void repeat(std::size_t at) {
    for (auto& lanes : blocks[at / kernels::kLanes].point) {
      for (std::size_t i = at % kernels::kLanes + 1; i < kernels::kLanes; ++i)
        lanes[i] = lanes[at % kernels::kLanes];
    }
  }
  void move_up() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (is_used(i)) put(count++, pairs[i], points(i));
    }
    pairs.resize(count);
    blocks.resize((count + kernels::kLanes - 1) / kernels::kLanes);
    used.assign(blocks.size(), 0xffff);
    left_out = 0;
    if (count % kernels::kLanes == 0) return;
    repeat(count - 1);
    used.back() = static_cast<std::uint16_t>((1u << count % kernels::kLanes) - 1);
  }
};

/// Lists of pairs: points beside triangles, and edges; those of the cloth with bodies come first,
/// then those of the cloth with itself, which begin with features in one star (stars.h).
inline constexpr std::size_t kBodyLists = 2, kStarLists = 2, kPairLists = 6;
inline constexpr bool has_edges(std::size_t list) { return list % 2 == 1; }
inline constexpr std::size_t list_of(const Pair& pair) {
  return (pair.is_within_cloth() ? kBodyLists + kStarLists : 0) +
         (pair.kind == PairKind::edges ? 1 : 0);
}
inline constexpr std::size_t star_list_of(PairKind kind) {
  return kBodyLists + (kind == PairKind::edges ? 1 : 0);
}
inline constexpr bool is_of_stars(std::size_t list) {
  return list >= kBodyLists && list < kBodyLists + kStarLists;
}

/// Candidates, by lists of pairs.
using Candidates = std::array<PairList, kPairLists>;

}  // namespace weft
