#include "engine/step/anchors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/validate.h"

namespace weft {

Anchors::Anchors(const Model& model) {
  for (const Anchor& anchor : model.anchors.described) {
    from_.push_back(pose_of(anchor.point, anchor.normal));
    asked_.push_back({.max_distance = anchor.max_distance});
    most_to_.push_back(anchor.max_distance);
  }
  to_ = from_;
  most_from_ = most_before_ = most_to_;
  has_backstop_.assign(asked_.size(), 1);
  tie(model.anchors, model.initial_position);
}

void Anchors::tie(const AnchorStore& store, const kernels::Vectors& x) {
  const std::size_t described = asked_.size();
  for (auto* poses : {&from_, &to_}) {
    poses->resize(described);
    for (const std::uint32_t pin : store.pins) poses->push_back({.point = x[pin]});
  }
  for (auto* most : {&most_from_, &most_before_, &most_to_}) {
    most->resize(described);
    for (std::size_t i = described; i < store.size(); ++i) most->push_back(store.limits[i].most);
  }
  has_backstop_.resize(store.size(), 1);
}

/// 0 and infinity stay.
double Anchors::most(const AnchorLimit& limit) const {
  return std::isfinite(limit.max_distance) ? scale_ * limit.max_distance : limit.max_distance;
}

void Anchors::limit(std::uint32_t anchor, const AnchorLimit& limit) {
  asked_[anchor] = limit;
  most_to_[anchor] = most(limit);
  has_backstop_[anchor] = limit.backstop;
  limited_ = true;
}

void Anchors::limit(std::span<const AnchorLimit> limits) {
  for (std::uint32_t i = 0; i < limits.size(); ++i) limit(i, limits[i]);
}

void Anchors::scale(double scale) {
  scale_ = scale;
  limit(std::vector(asked_));
}

void Anchors::follow_pins(const AnchorStore& store, const kernels::Vectors& x,
                          const kernels::Vectors& v, double dt) {
  for (std::size_t i = 0; i < store.pins.size(); ++i) {
    const std::uint32_t pin = store.pins[i];
    const kernels::Vector way = dt * v[pin];
    const std::size_t anchor = asked_.size() + i;
    from_[anchor].point = x[pin];
    to_[anchor].point = x[pin] + way;
    moves_ = moves_ || dot(way, way) > 0;
  }
}

void Anchors::depart(const AnchorStore& store, const kernels::Vectors& x, const kernels::Vectors& v,
                     double dt) {
  follow_pins(store, x, v, dt);
  most_before_ = most_from_;
  for (std::size_t i = 0; i < most_to_.size(); ++i) {
    if (std::isinf(most_from_[i]) && std::isfinite(most_to_[i]))
      most_from_[i] = std::max(most_to_[i], length(x[store.slot[i]] - from_[i].point));
    if (std::isinf(most_to_[i])) most_from_[i] = most_to_[i];
  }
}

void Anchors::move(std::span<const Vec3> points, std::span<const Vec3> normals) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    reference::AnchorPose to{{points[i].x, points[i].y, points[i].z}, to_[i].normal};
    if (!normals.empty()) to.normal = pose_of(points[i], normals[i]).normal;
    moves_ = moves_ || to.point != to_[i].point || to.normal != to_[i].normal;
    to_[i] = to;
  }
}

void Anchors::teleport() {
  from_ = to_;
  most_from_ = most_to_;
  moves_ = false;
}

void Anchors::stop(bool arrived) {
  if (!arrived) return most_from_.swap(most_before_);
  moved_ = std::exchange(moves_, false);
  if (moved_) from_ = to_;
  most_from_ = most_to_;
}

double Anchors::largest_excess(const AnchorStore& store, const kernels::Vectors& x,
                               bool ends) const {
  double most = 0;
  for (std::size_t i = 0; i < store.size(); ++i) {
    const reference::AnchorPose& pose = ends ? to_[i] : from_[i];
    const reference::AnchorMotion at{.point = pose.point, .normal = pose.normal};
    reference::AnchorLimits limits = store.limits[i];
    limits.most = ends ? most_to_[i] : most_from_[i];
    limits.has_backstop = limits.has_backstop && has_backstop_[i] != 0;
    most = std::max(most, reference::excess(limits, at, x[store.slot[i]]));
  }
  return most;
}

bool Anchors::fit(const Model& model) const {
  const std::size_t count = model.anchors.size();
  const bool are_as_many = from_.size() == count && to_.size() == count &&
                           asked_.size() == model.anchors.described.size() &&
                           most_from_.size() == count && most_to_.size() == count &&
                           has_backstop_.size() == count;
  return are_as_many && validate_anchor_limits(model, asked_);
}

std::size_t Anchors::bytes() const {
  return bytes_of(from_) + bytes_of(to_) + bytes_of(asked_) + bytes_of(most_from_) +
         bytes_of(most_before_) + bytes_of(most_to_) + bytes_of(has_backstop_);
}

}  // namespace weft
