#include "engine/step/anchors.h"

#include <algorithm>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {

namespace {

bool same(kernels::Vector a, kernels::Vector b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

Anchors::Anchors(const Model& model) {
  for (const Anchor& anchor : model.anchors.described) {
    from_.push_back(pose_of(anchor.point, anchor.normal));
  }
  to_ = from_;
}

void Anchors::move(std::span<const Vec3> points, std::span<const Vec3> normals) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    reference::AnchorPose to{{points[i].x, points[i].y, points[i].z}, to_[i].normal};
    if (!normals.empty()) to.normal = pose_of(points[i], normals[i]).normal;
    moves_ = moves_ || !same(to.point, to_[i].point) || !same(to.normal, to_[i].normal);
    to_[i] = to;
  }
}

void Anchors::put_down() {
  from_ = to_;
  moves_ = false;
}

void Anchors::arrive() {
  moved_ = std::exchange(moves_, false);
  if (moved_) from_ = to_;
}

double Anchors::largest_excess(const AnchorStore& store, const kernels::Vectors& x,
                               bool ends) const {
  double most = 0;
  for (std::size_t i = 0; i < store.size(); ++i) {
    const reference::AnchorPose& pose = ends ? to_[i] : from_[i];
    const reference::AnchorMotion at{.point = pose.point, .normal = pose.normal};
    most = std::max(most, reference::excess(store.limits[i], at, x[store.slot[i]]));
  }
  return most;
}

std::size_t Anchors::bytes() const { return bytes_of(from_) + bytes_of(to_); }

}  // namespace weft
