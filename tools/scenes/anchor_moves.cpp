#include "tools/scenes/anchor_moves.h"

#include <algorithm>
#include <cstddef>

#include "engine/model/model.h"

namespace weft::tools {

MovedAnchors::MovedAnchors(std::span<const PinMove> moves, const Cloth& cloth) : moves_(moves) {
  for (const Anchor& anchor : cloth.model()->anchors.described) {
    points_.push_back(anchor.point);
    normals_.push_back(anchor.normal);
  }
  any_ = std::ranges::any_of(moves, [](const PinMove& move) { return !move.anchors.empty(); });
}

Result<void> MovedAnchors::send(Cloth& cloth, double time) const {
  if (!any_) return {};
  std::vector<Vec3> points = points_, normals = normals_;
  for (const PinMove& move : moves_) {
    for (std::size_t k = 0; k < move.anchors.size(); ++k) {
      const std::uint32_t anchor = move.anchors[k];
      const Vec3 from = move.from.empty() ? points_[anchor] : move.from[k];
      points[anchor] = place_at(move, time, from);
      normals[anchor] = turned_at(move, time, normals_[anchor]);
    }
  }
  return cloth.move_anchors(points, normals);
}

}  // namespace weft::tools
