/// The places of a cloth's anchors, and the places to which they travel (Cloth::move_anchors).
/// Anchors have the numbers of the model.
#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/saving/fields.h"
#include "engine/solvers/small_steps/anchor_travel.h"

namespace weft {

void visit_fields(Is<reference::AnchorPose> auto& pose, auto& archive) {
  auto& [point, normal] = pose;
  archive(point, normal);
}

class Anchors {
 public:
  Anchors() = default;
  explicit Anchors(const Model& model);
  /// Behind the described ones: tethers, which are where their pins are. x: of the particles.
  void tie(const AnchorStore& store, const kernels::Vectors& x);

  /// normals: or none, and they stay.
  void move(std::span<const Vec3> points, std::span<const Vec3> normals);
  /// All positions were replaced: no anchor travels, and limits change at once.
  void teleport();
  /// All are taken along: moved(point), turned(normal).
  template <class Moved, class Turned>
  void carry(Moved&& moved, Turned&& turned) {
    for (auto* poses : {&from_, &to_}) {
      for (auto& pose : *poses) pose = {moved(pose.point), turned(pose.normal)};
    }
  }
  /// The limits of all from the next step on.
  void limit(std::span<const AnchorLimit> limits);
  void limit(std::uint32_t anchor, const AnchorLimit& limit);
  void scale(double scale);
  const std::vector<AnchorLimit>& limits() const { return asked_; }
  /// Before a step of dt, when pins are under way: a particle that is held again begins where it
  /// is.
  void depart(const AnchorStore& store, const kernels::Vectors& x, const kernels::Vectors& v,
              double dt);
  /// After depart. arrived: the step was done; else all is as it was before.
  void stop(bool arrived);

  AnchorTravel travel() const {
    return {from_, to_, most_from_, most_to_, has_backstop_, moving(), limited_};
  }
  /// They stand where they are.
  AnchorTravel standing() const {
    return {from_, from_, most_from_, most_from_, has_backstop_, false, limited_};
  }
  /// m, the largest by which a limit is exceeded: where a step ends, or begins.
  double largest_excess(const AnchorStore& store, const kernels::Vectors& x, bool ends) const;
  /// Whether a particle at x is as far from the point of a described anchor as it may be.
  bool is_at_limit(std::uint32_t anchor, kernels::Vector x, double tolerance) const {
    return length(x - from_[anchor].point) >= most_from_[anchor] - tolerance;
  }
  /// Whether one moves in this step or has moved in the last.
  bool moving() const { return moves_ || moved_ || most_from_ != most_to_; }
  std::size_t bytes() const;
  friend void visit_fields(Is<Anchors> auto& anchors, auto& archive) {
    auto& [from, to, asked, most_from, most_before, most_to, has_backstop, scale, limited, moves,
           moved] = anchors;  // depart() sets most_before
    archive(from, to, asked, most_from, most_to, has_backstop, scale, limited, moves, moved);
  }
  /// Whether those that were read are the model's.
  bool fit(const Model& model) const;

 private:
  double most(const AnchorLimit& limit) const;
  void follow_pins(const AnchorStore& store, const kernels::Vectors& x, const kernels::Vectors& v,
                   double dt);

  std::vector<reference::AnchorPose> from_, to_;
  std::vector<AnchorLimit> asked_;                         // of the described ones
  std::vector<double> most_from_, most_before_, most_to_;  // m, scaled; before the present step
  std::vector<std::uint8_t> has_backstop_;
  double scale_ = 1;
  bool limited_ = false;                // something was asked for that the description did not
  bool moves_ = false, moved_ = false;  // in the next step, in the last one
};

}  // namespace weft
