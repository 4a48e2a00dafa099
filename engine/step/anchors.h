/// Where the anchors of a cloth are, and where they travel to (Cloth::move_anchors). Their numbers
/// are those of the model's.
#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/anchor_travel.h"

namespace weft {

class Anchors {
 public:
  Anchors() = default;
  explicit Anchors(const Model& model);

  /// normals: or none, and they stay.
  void move(std::span<const Vec3> points, std::span<const Vec3> normals);
  /// All positions were replaced: nobody travels.
  void put_down();
  /// All are taken along: moved(point), turned(normal).
  template <class Moved, class Turned>
  void carry(Moved&& moved, Turned&& turned) {
    for (auto* poses : {&from_, &to_}) {
      for (auto& pose : *poses) pose = {moved(pose.point), turned(pose.normal)};
    }
  }
  /// A step was done.
  void arrive();

  AnchorTravel travel() const { return {from_, to_, moving()}; }
  /// They stand where they are.
  AnchorTravel standing() const { return {from_, from_, false}; }
  /// m, the largest by which a limit is exceeded: where a step ends, or begins.
  double largest_excess(const AnchorStore& store, const kernels::Vectors& x, bool ends) const;
  /// Whether one moves in this step or has moved in the last.
  bool moving() const { return moves_ || moved_; }
  std::size_t bytes() const;

 private:
  std::vector<reference::AnchorPose> from_, to_;
  bool moves_ = false, moved_ = false;  // in the next step, in the last one
};

}  // namespace weft
