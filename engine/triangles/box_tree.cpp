#include "engine/triangles/box_tree.h"

#include "engine/bytes_of.h"

namespace weft {

BoxTree::BoxTree(std::span<const std::uint32_t> in_order)
    : items_(in_order.begin(), in_order.end()), count_(in_order.size()) {
  const std::size_t clusters = (count_ + kernels::kLanes - 1) / kernels::kLanes;
  clusters_.resize(clusters);
  leaves_ = std::bit_ceil(std::max<std::size_t>(1, clusters));
  nodes_.assign(2 * leaves_, Box::none());
}

void BoxTree::join() {
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    nodes_[node] = nodes_[2 * node];
    nodes_[node].add(nodes_[2 * node + 1]);
  }
}

std::size_t BoxTree::bytes() const {
  return bytes_of(items_) + bytes_of(clusters_) + bytes_of(nodes_);
}

}  // namespace weft
