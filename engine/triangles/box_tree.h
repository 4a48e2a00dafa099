/// A tree of boxes around the primitives of a surface. Its clusters hold kLanes of them, neighbours
/// of each other; above these each node has two. It is built once, and refitted as points move.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

struct Box {
  std::array<float, 3> low, high;

  static Box none() {
    constexpr float kFar = std::numeric_limits<float>::max();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  static Box at(kernels::Vector place) {
    const std::array there{static_cast<float>(place.x), static_cast<float>(place.y),
                           static_cast<float>(place.z)};
    return {there, there};
  }
  void add(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  bool holds(const Box& other) const {
    bool holds = true;
    for (std::size_t k = 0; k < 3; ++k)
      holds = holds && low[k] <= other.low[k] && high[k] >= other.high[k];
    return holds;
  }
  /// Keeps only the part that the other one has, too.
  void leave(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::max(low[k], other.low[k]);
      high[k] = std::min(high[k], other.high[k]);
    }
  }
  bool is_none() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
  bool meets(const Box& other) const {
    bool meets = true;
    for (std::size_t k = 0; k < 3; ++k)
      meets = meets && low[k] <= other.high[k] && high[k] >= other.low[k];
    return meets;
  }
};

class BoxTree {
 public:
  BoxTree() = default;
  /// in_order: the primitives, so that neighbours stand near to each other.
  explicit BoxTree(std::span<const std::uint32_t> in_order);

  /// box_of(primitive): where it is now.
  template <class BoxOf>
  void refit(BoxOf&& box_of);
  /// visit(a, b), of all primitives of two trees whose boxes meet.
  template <class Visit>
  static void meet(const simd::Table& table, const BoxTree& a, const BoxTree& b, Visit&& visit);
  /// The same of pairs of one tree, each once and none with itself.
  template <class Visit>
  static void meet_itself(const simd::Table& table, const BoxTree& tree, Visit&& visit);
  /// visit(primitive), of those whose boxes meet this one.
  template <class Visit>
  void find(const simd::Table& table, const Box& box, Visit&& visit) const;
  /// visit(primitive) returns how far away the query still looks for (m, squared): nodes that are
  /// farther from the point are passed over.
  template <class Visit>
  void near(const std::array<float, 3>& point, Visit&& visit) const;
  /// Around all of it; of a tree that has primitives.
  const Box& box() const { return nodes_[1]; }
  bool empty() const { return count_ == 0; }
  std::size_t bytes() const;

 private:
  bool is_leaf(std::size_t node) const { return node >= leaves_; }
  Box box_in(std::size_t cluster, std::size_t lane) const {
    const simd::BoxCluster& c = clusters_[cluster];
    return {{c.low[0][lane], c.low[1][lane], c.low[2][lane]},
            {c.high[0][lane], c.high[1][lane], c.high[2][lane]}};
  }
  /// Whose boxes meet this one, a bit each. An infinite box would meet those that fill up a
  /// cluster, and the leaves after the last one.
  std::uint32_t met_in(const simd::Table& table, std::size_t cluster, const Box& box) const {
    if (cluster >= clusters_.size()) return 0;
    const auto lanes = std::min<std::size_t>(count_ - cluster * kernels::kLanes, kernels::kLanes);
    return table.find_met(clusters_[cluster], box.low.data(), box.high.data()) &
           ((std::uint32_t{1} << lanes) - 1);
  }
  void join();

  std::size_t leaves_ = 1;            // nodes 1 ... leaves_ - 1 have the children 2 i and 2 i + 1
  std::vector<std::uint32_t> items_;  // per cluster and lane
  std::size_t count_ = 0;
  kernels::AlignedVector<simd::BoxCluster> clusters_;
  std::vector<Box> nodes_;
};

template <class BoxOf>
void BoxTree::refit(BoxOf&& box_of) {
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    Box sum = Box::none();
    simd::BoxCluster& cluster = clusters_[c];
    for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
      const std::size_t at = c * kernels::kLanes + lane;
      const Box box = at < count_ ? box_of(items_[at]) : Box::none();
      for (std::size_t k = 0; k < 3; ++k) {
        cluster.low[k][lane] = box.low[k];
        cluster.high[k][lane] = box.high[k];
      }
      sum.add(box);
    }
    nodes_[leaves_ + c] = sum;
  }
  join();
}

template <class Visit>
void BoxTree::find(const simd::Table& table, const Box& box, Visit&& visit) const {
  if (clusters_.empty()) return;
  std::array<std::size_t, 64> waiting;
  std::size_t count = 0;
  waiting[count++] = 1;
  while (count > 0) {
    const std::size_t node = waiting[--count];
    if (!box.meets(nodes_[node])) continue;
    if (!is_leaf(node)) {
      waiting[count++] = 2 * node + 1;
      waiting[count++] = 2 * node;
      continue;
    }
    const std::size_t cluster = node - leaves_;
    for (std::uint32_t met = met_in(table, cluster, box); met != 0; met &= met - 1) {
      visit(items_[cluster * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(met))]);
    }
  }
}

template <class Visit>
void BoxTree::meet(const simd::Table& table, const BoxTree& a, const BoxTree& b, Visit&& visit) {
  if (a.clusters_.empty() || b.clusters_.empty()) return;
  std::array<std::pair<std::size_t, std::size_t>, 128> waiting;
  std::size_t count = 0;
  waiting[count++] = {1, 1};
  while (count > 0) {
    const auto [i, j] = waiting[--count];
    if (!a.nodes_[i].meets(b.nodes_[j])) continue;
    if (!a.is_leaf(i) && (b.is_leaf(j) || std::bit_width(i) <= std::bit_width(j))) {
      waiting[count++] = {2 * i + 1, j};
      waiting[count++] = {2 * i, j};
      continue;
    }
    if (!b.is_leaf(j)) {
      waiting[count++] = {i, 2 * j + 1};
      waiting[count++] = {i, 2 * j};
      continue;
    }
    const std::size_t mine = i - a.leaves_, its = j - b.leaves_;
    for (std::uint32_t left = a.met_in(table, mine, b.nodes_[j]); left != 0; left &= left - 1) {
      const auto at = static_cast<std::size_t>(std::countr_zero(left));
      for (std::uint32_t met = b.met_in(table, its, a.box_in(mine, at)); met != 0; met &= met - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(met));
        visit(a.items_[mine * kernels::kLanes + at], b.items_[its * kernels::kLanes + lane]);
      }
    }
  }
}

template <class Visit>
void BoxTree::meet_itself(const simd::Table& table, const BoxTree& tree, Visit&& visit) {
  if (tree.clusters_.empty()) return;
  std::array<std::pair<std::size_t, std::size_t>, 192> waiting;
  std::size_t count = 0;
  waiting[count++] = {1, 1};
  while (count > 0) {
    const auto [i, j] = waiting[--count];  // of one level
    if (!tree.nodes_[i].meets(tree.nodes_[j])) continue;
    if (!tree.is_leaf(i)) {
      waiting[count++] = {2 * i + 1, 2 * j + 1};
      if (i != j) waiting[count++] = {2 * i + 1, 2 * j};
      waiting[count++] = {2 * i, 2 * j + 1};
      waiting[count++] = {2 * i, 2 * j};
      continue;
    }
    const std::size_t mine = i - tree.leaves_, its = j - tree.leaves_;
    for (std::uint32_t left = tree.met_in(table, mine, tree.nodes_[j]); left != 0;
         left &= left - 1) {
      const auto at = static_cast<std::size_t>(std::countr_zero(left));
      const std::uint32_t after = i == j ? ~std::uint32_t{0} << at << 1 : ~std::uint32_t{0};
      for (std::uint32_t met = tree.met_in(table, its, tree.box_in(mine, at)) & after; met != 0;
           met &= met - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(met));
        visit(tree.items_[mine * kernels::kLanes + at], tree.items_[its * kernels::kLanes + lane]);
      }
    }
  }
}

template <class Visit>
void BoxTree::near(const std::array<float, 3>& point, Visit&& visit) const {
  if (clusters_.empty()) return;
  const auto square_to = [&](const Box& box) {
    float square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const float beyond = std::max({box.low[k] - point[k], point[k] - box.high[k], 0.f});
      square += beyond * beyond;
    }
    return square;
  };
  float most = std::numeric_limits<float>::max();
  std::array<std::pair<float, std::size_t>, 64> waiting;
  std::size_t count = 0;
  waiting[count++] = {square_to(nodes_[1]), 1};
  while (count > 0) {
    const auto [square, node] = waiting[--count];
    if (square > most) continue;
    if (is_leaf(node)) {
      const std::size_t first = (node - leaves_) * kernels::kLanes;
      const std::size_t last = std::min(first + kernels::kLanes, count_);
      for (std::size_t at = first; at < last; ++at) {
        if (square_to(box_in(node - leaves_, at - first)) <= most) most = visit(items_[at]);
      }
      continue;
    }
    std::pair<float, std::size_t> children[] = {{square_to(nodes_[2 * node]), 2 * node},
                                                {square_to(nodes_[2 * node + 1]), 2 * node + 1}};
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);
    for (const auto& child : children) waiting[count++] = child;
  }
}

}  // namespace weft
