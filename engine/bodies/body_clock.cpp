#include "engine/bodies/body_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {

using kernels::Vector;

void BodyClock::begin(std::span<const TravellingBody> bodies, double dt_substep, int substeps,
                      bool stands) {
  bodies_.assign(bodies.begin(), bodies.end());
  dt_substep_ = dt_substep;
  substeps_ = substeps;
  done_ = 0;
  interval_ = interval_left_ = 0;
  stands_ = stands;
  motions_.resize(bodies.size());
  const double per_second = stands ? 0 : 1 / (dt_substep * substeps);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const TravellingBody& body = bodies[i];
    const reference::Placement at = body.travel.at(0);
    motions_[i] = {.form = body.shape->form(),
                   .from = at,
                   .to = at,
                   .velocity = per_second * body.travel.way(),
                   .spin = per_second * body.travel.turn(),
                   .thickness = body.thickness,
                   .friction = stands ? 0 : body.friction,
                   .h = this->dt_substep()};
  }
}

double BodyClock::dt_substep() const {
  return stands_ ? std::numeric_limits<double>::infinity() : dt_substep_;
}

void BodyClock::begin_interval(double time) {
  const double substeps = std::max(1.0, std::floor(time / dt_substep_));
  interval_ = static_cast<int>(std::min<double>(substeps, substeps_ - done_));
  interval_left_ = interval_;
}

void BodyClock::advance() {
  ++done_;
  --interval_left_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    motions_[i].from = motions_[i].to;
    motions_[i].to = bodies_[i].travel.at(share(done_));
  }
}

/// A corner that turns by an angle stays within length * angle^2 / 8 of the line between its ends.
BodyClock::Box BodyClock::box(std::size_t body, int substeps) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TravellingBody& b = bodies_[body];
  const FormBounds& bounds = b.shape->bounds();
  if (!bounds.has_end)
    return {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  const double to = share(std::min(substeps_, done_ + substeps));
  const double angle = length(b.travel.turn()) * (to - share(done_));
  const reference::Placement ends[] = {b.travel.at(share(done_)), b.travel.at(to)};
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const Vector corner : bounds.corners) {
    const double beyond = bounds.spread * b.thickness;
    const double wide = bounds.radius + beyond + (length(corner) + beyond) * angle * angle / 8;
    for (const reference::Placement& end : ends) {
      const Vector at = end.placed(corner);
      box.low = {std::min(box.low.x, at.x - wide), std::min(box.low.y, at.y - wide),
                 std::min(box.low.z, at.z - wide)};
      box.high = {std::max(box.high.x, at.x + wide), std::max(box.high.y, at.y + wide),
                  std::max(box.high.z, at.z + wide)};
    }
  }
  return box;
}

double BodyClock::fastest(std::size_t body) const {
  const FormBounds& bounds = bodies_[body].shape->bounds();
  double farthest = 0;
  for (const Vector corner : bounds.corners) farthest = std::max(farthest, length(corner));
  const reference::BodyMotion& motion = motions_[body];
  return length(motion.velocity) + length(motion.spin) * (farthest + bounds.radius);
}

}  // namespace weft
