#include "engine/contact/speeds.h"

#include <algorithm>
#include <cmath>

#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

Box box_at(Vector low, Vector high) {
  return {{static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(low.z)},
          {static_cast<float>(high.x), static_cast<float>(high.y), static_cast<float>(high.z)}};
}

/// The cloth as a whole, from `origin`.
struct ClothInStep {
  Vector origin{}, mean{};  // mean: m/s
  Tube places{Box::none(), Box::none()};

  ClothInStep(const Model& model, std::span<const Vector> starts, std::span<const Vector> ways,
              double h, double time) {
    double count = 0;
    for (std::uint32_t slot = 0; slot < starts.size(); ++slot) {
      if (!model.is_particle(slot)) continue;
      if (count == 0) origin = starts[slot];
      mean = mean + ways[slot];
      ++count;
      const Vector from = starts[slot] - origin, to = from + (time / h) * ways[slot];
      places.begins.add(box_at(from, from));
      places.ends.add(box_at(to, to));
    }
    mean = (1 / (h * std::max(1.0, count))) * mean;
  }
};

/// m/s
double fastest_beside(const Model& model, std::span<const Vector> ways, double h, Vector drift) {
  double most = 0;
  for (std::uint32_t slot = 0; slot < ways.size(); ++slot) {
    const Vector by = ways[slot] - h * drift;
    if (model.is_particle(slot)) most = std::max(most, dot(by, by));
  }
  return std::sqrt(most) / h;
}

/// Where in its coordinates the cloth may come to a body.
Box region_of(const ClothInStep& cloth, const ContactSurface& body, const PoseTravel& travel,
              double beyond) {
  SeenFromBody seen{.begins = travel.at(0),
                    .ends = travel.at(1),
                    .turn = length(travel.turn()),
                    .way = length(travel.way()),
                    .beyond = beyond};
  for (reference::Placement* at : {&seen.begins, &seen.ends})
    at->centre = at->centre - cloth.origin;
  Box region = seen(cloth.places);
  region.leave(body.extent);
  return region;
}

/// m: no vertex in the region takes a longer way in the coordinates of its body.
double longest_in(const ContactSurface& body, const Box& region) {
  if (body.longest == 0) return 0;
  double most = 0;
  for (std::size_t i = 0; i < body.from.size(); ++i) {
    Box place = box_at(body.from[i], body.from[i]);
    place.add(box_at(body.to[i], body.to[i]));
    if (!place.meets(region)) continue;
    const Vector way = body.to[i] - body.from[i];
    most = std::max(most, dot(way, way));
  }
  return std::sqrt(most);
}

/// m/s: nothing of a body in the box, which is in its coordinates, is faster beside the drift. Its
/// middle has another velocity as it turns.
double fastest_in(const Box& box, const reference::BodyMotion& motion, double time, Vector drift) {
  const auto at = [&](auto&& of) { return Vector{of(0), of(1), of(2)}; };
  const auto low = [&](std::size_t k) { return static_cast<double>(box.low[k]); };
  const auto high = [&](std::size_t k) { return static_cast<double>(box.high[k]); };
  const Vector middle = at([&](std::size_t k) { return 0.5 * (low(k) + high(k)); });
  const Vector half = at([&](std::size_t k) { return 0.5 * (high(k) - low(k)); });
  const Vector arm = motion.to.turned(middle);
  const double spin = length(motion.spin);
  return length(motion.velocity + cross(motion.spin, arm) - drift) +
         spin * (spin * time * length(arm) + length(half));
}

}  // namespace

ContactSpeeds speeds_of_step(const Model& model, std::span<const Vector> starts,
                             std::span<const Vector> ways, std::span<const ContactSurface> bodies,
                             const BodyClock& clock) {
  const double time = clock.time(), h = clock.dt_substep();
  const ClothInStep cloth(model, starts, ways, h, time);
  const double of_cloth = fastest_beside(model, ways, h, {});
  const auto speeds_beside = [&](Vector drift) {
    ContactSpeeds speeds{.drift = drift, .of_cloth = fastest_beside(model, ways, h, drift)};
    for (const ContactSurface& body : bodies) {
      const reference::BodyMotion& motion = clock.motions()[body.body];
      speeds.of_bodies = std::max(
          speeds.of_bodies, fastest_in(body.extent, motion, time, drift) + body.longest / time);
      const double beyond =
          tuning::kContactReach * of_cloth * time + tuning::kContactRegion * body.thickness;
      const Box region = region_of(cloth, body, clock.bodies()[body.body].travel, beyond);
      if (region.is_none()) continue;
      speeds.of_near = std::max(speeds.of_near, fastest_in(region, motion, time, drift) +
                                                    longest_in(body, region) / time);
    }
    return speeds;
  };
  const ContactSpeeds still = speeds_beside({}), moving = speeds_beside(cloth.mean);
  // Cloth that lies still is predicted to fall for a substep: that is no drift.
  const double of_load = tuning::kCalmAcceleration * h;
  return std::max(moving.of_cloth, moving.of_near) + of_load < std::max(of_cloth, still.of_near)
             ? moving
             : still;
}

}  // namespace weft
