#include "engine/contact/narrow_gaps.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

bool is_closed_form(const ContactScene& scene, std::uint32_t body) {
  return scene.clock.bodies()[body].mesh == nullptr;
}

}  // namespace

/// Particles with near pairs of two bodies, or of one and a body of a closed form, whose normals
/// are against each other.
void NarrowGaps::find_slots(const ContactScene& scene, const Near& near) {
  facing_.clear();
  for (const NearPairs& pairs : near) {
    for (std::size_t i = 0; i < pairs.list.size(); ++i) {
      const Pair& pair = pairs.list.pairs[i];
      const Vector normal = pair.outward() * pairs.normal(i);
      for (const std::uint32_t point : pairs.list.points(i)) {
        if (scene.points.is_of_cloth(point))
          facing_.push_back({point, scene.points.later(pair).body, normal});
      }
    }
  }
  std::ranges::sort(facing_, {}, &Facing::slot);
  for (std::size_t first = 0, last = 0; first < facing_.size(); first = last) {
    const std::uint32_t slot = facing_[first].slot;
    at_one_.clear();
    for (; last < facing_.size() && facing_[last].slot == slot; ++last)
      at_one_.push_back(facing_[last]);
    for (std::uint32_t body = 0; body < scene.clock.bodies().size(); ++body) {
      if (!is_closed_form(scene, body)) continue;
      const reference::BodyMotion& motion = scene.clock.motions()[body];
      const Vector place = motion.to.from_place(scene.points.start(slot));
      at_one_.push_back({slot, body, motion.to.turned(gap_of(*motion.form, 0, place).normal)});
    }
    // By less than what counts in a substep: normals turn until the interval is over.
    const auto are_against = [](const Facing& a, const Facing& b) {
      return a.body != b.body && dot(a.normal, b.normal) < -tuning::kAgainst / 2;
    };
    const bool is_between = std::ranges::any_of(at_one_, [&](const Facing& a) {
      return std::ranges::any_of(at_one_, [&](const Facing& b) { return are_against(a, b); });
    });
    if (is_between) slots_.push_back(slot);
  }
}

NarrowGaps::Feature NarrowGaps::feature_of(const ContactScene& scene, const Pair& pair) {
  return {.body = scene.points.later(pair).body,
          .index = pair.is_turned() ? pair.first : pair.second,
          .kind = pair.kind,
          .is_vertex = pair.is_turned()};
}

void NarrowGaps::find_features(const ContactScene& scene, const Near& near) {
  features_.clear();
  for (const Place& place : pairs_)
    features_.push_back(feature_of(scene, near[place.list].list.pairs[place.pair]));
  std::ranges::sort(features_);
  erase_repeated(features_);
  for (Place& place : pairs_) {
    const Feature feature = feature_of(scene, near[place.list].list.pairs[place.pair]);
    place.feature = static_cast<std::uint32_t>(std::ranges::lower_bound(features_, feature) -
                                               features_.begin());
  }
}

void NarrowGaps::find_pairs(const Near& near) {
  for (std::uint32_t list = 0; list < kBodyLists; ++list) {
    for (std::uint32_t i = 0; i < near[list].list.size(); ++i) {
      const bool is_between = std::ranges::any_of(
          near[list].list.points(i),
          [&](std::uint32_t point) { return std::ranges::binary_search(slots_, point); });
      if (is_between) pairs_.push_back({list, i});
    }
  }
}

void NarrowGaps::begin(const ContactScene& scene, const Near& near) {
  pairs_.clear();
  slots_.clear();
  beside_.clear();
  if (scene.clock.bodies().size() < 2) return;
  find_slots(scene, near);
  if (slots_.empty()) return;
  find_pairs(near);
  find_features(scene, near);
  for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
    for (const std::uint32_t point : near[pairs_[i].list].list.points(pairs_[i].pair)) {
      if (scene.points.is_of_cloth(point)) beside_.push_back({point, pairs_[i].feature, i});
    }
  }
  std::ranges::sort(beside_);
}

std::span<const NarrowGaps::OfSlot> NarrowGaps::beside(std::uint32_t slot) const {
  const auto first = std::ranges::lower_bound(beside_, slot, {}, &OfSlot::slot);
  const auto last = std::ranges::upper_bound(beside_, slot, {}, &OfSlot::slot);
  return {beside_.data() + (first - beside_.begin()), static_cast<std::size_t>(last - first)};
}

NarrowGaps::Seen NarrowGaps::see(const ContactScene& scene, const NearPairs& near,
                                 std::size_t i) const {
  const Pair& pair = near.list.pairs[i];
  Seen seen{.points = near.list.points(i)};
  for (std::size_t k = 0; k < 4; ++k) seen.x[k] = scene.start(seen.points[k]);
  const reference::Nearest found = nearest(pair.kind, seen.x);
  seen.is_in_place = is_in_place(pair.kind, found);
  const Vector side = near.normal(i);
  const double l = length(found.r), sign = dot(found.r, side) >= 0 ? 1 : -1;
  const Vector n = l > kTouching ? (sign / l) * found.r : side;
  const ContactSurface& later = scene.points.later(pair);
  seen.radius = later.radius_at(seen.points, found.weight);
  seen.clearance = {.body = later.body,
                    .normal = pair.outward() * n,
                    .distance = sign * l - seen.radius,
                    .thickness = near.states[i].thickness - later.largest_radius()};
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = seen.weight[k] = std::abs(found.weight[k]);
    if (scene.points.is_of_cloth(seen.points[k])) {
      seen.at = seen.at + weight * seen.x[k];
    } else {
      const Vector way = scene.present[seen.points[k]].x - seen.x[k];
      seen.clearance.velocity = seen.clearance.velocity + (weight / scene.clock.dt_substep()) * way;
    }
  }
  return seen;
}

namespace {

/// From the nearest place of a vertex, an edge or a triangle.
Vector from_nearest(Vector at, std::span<const Vector> corners) {
  if (corners.size() == 1) return at - corners[0];
  if (corners.size() == 3)
    return reference::nearest_in_triangle(at, corners[0], corners[1], corners[2]).r;
  const double share = reference::share_of_segment(at, corners[0], corners[1]);
  return at - corners[0] - share * (corners[1] - corners[0]);
}

}  // namespace

BodyClearance NarrowGaps::clearance_at(const ContactScene& scene, const Seen& of, Vector at) {
  std::array<Vector, 3> corners{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!scene.points.is_of_cloth(of.points[k])) corners[count++] = of.x[k];
  }
  const Vector r = from_nearest(at, std::span(corners).first(count));
  const double l = length(r), sign = dot(r, of.clearance.normal) >= 0 ? 1 : -1;
  BodyClearance clearance = of.clearance;
  clearance.distance = sign * l - of.radius;
  if (l > kTouching) clearance.normal = (sign / l) * r;
  return clearance;
}

/// It is the clearance of particles alone: between them a closed form may be through the cloth.
BodyClearance NarrowGaps::clearance_of_particles(const ContactScene& scene, std::uint32_t body,
                                                 const Seen& here) {
  BodyClearance clearance = clearance_of(scene.clock, body, here.at, 0);
  clearance.distance = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t point = here.points[k];
    if (!scene.points.is_of_cloth(point) || here.weight[k] == 0) continue;
    const double radius = scene.model.has_spheres() ? scene.model.radius[point] : 0;
    clearance.distance += here.weight[k] * clearance_of(scene.clock, body, here.x[k], 0).distance;
    clearance.thickness += here.weight[k] * radius;
  }
  return clearance;
}

/// The clearance of the nearest feature of a body counts.
void NarrowGaps::take_nearest(const BodyClearance& clearance) {
  for (BodyClearance& known : clearances_) {
    if (known.body != clearance.body) continue;
    if (std::abs(clearance.distance) < std::abs(known.distance)) known = clearance;
    return;
  }
  clearances_.push_back(clearance);
}

void NarrowGaps::share(const ContactScene& scene, const Near& near) {
  seen_.clear();
  for (const Place& place : pairs_) seen_.push_back(see(scene, near[place.list], place.pair));
  last_.assign(features_.size(), kNoIndex);
  for (std::uint32_t i = 0; i < seen_.size(); ++i) {
    if (seen_[i].is_in_place && seen_[i].clearance.distance < 2 * scene.points.largest_thickness())
      share_at(scene, i);
  }
}

/// Each feature of another body is asked once, though it has pairs with each feature of the cloth
/// around the place.
void NarrowGaps::share_at(const ContactScene& scene, std::uint32_t at) {
  const Seen& here = seen_[at];
  std::array<std::uint32_t, 3> slots{};
  std::size_t count = 0;
  for (const std::uint32_t point : here.points) {
    if (scene.points.is_of_cloth(point)) slots[count++] = point;
  }
  const std::span<const std::uint32_t> of_cloth = std::span(slots).first(count);
  clearances_.clear();
  for (const std::uint32_t slot : of_cloth) {
    for (const OfSlot& other : beside(slot)) {
      std::uint32_t& last = last_[other.feature];
      if (last == at) continue;
      const Seen& there = seen_[other.pair];
      if (there.clearance.body == here.clearance.body ||
          dot(there.clearance.normal, here.clearance.normal) >= -tuning::kAgainst)
        continue;
      last = at;
      take_nearest(clearance_at(scene, there, here.at));
    }
  }
  for (std::uint32_t body = 0; body < scene.clock.bodies().size(); ++body) {
    if (is_closed_form(scene, body))
      clearances_.push_back(clearance_of_particles(scene, body, here));
  }
  for (const BodyClearance& other : clearances_)
    scene.shares.share(here.clearance, other, scene.clock.dt_substep(), of_cloth);
}

void NarrowGaps::take_in(const ContactScene& scene, const Near& near, Tangles& tangles) const {
  if (!scene.shares.any()) return;
  for (const Place& place : pairs_) {
    const NearPairs& pairs = near[place.list];
    const Pair& pair = pairs.list.pairs[place.pair];
    const double thickness =
        pairs.states[place.pair].thickness - scene.points.later(pair).largest_radius();
    const auto points = pairs.list.points(place.pair);
    const bool lets_in = std::ranges::any_of(points, [&](std::uint32_t point) {
      return scene.points.is_of_cloth(point) &&
             scene.shares.of(point, scene.points.later(pair).body).by > thickness;
    });
    if (lets_in && pairs.is_under(place.pair)) tangles.let_in(scene.points, pair);
  }
}

std::size_t NarrowGaps::bytes() const {
  return bytes_of(pairs_) + bytes_of(features_) + bytes_of(slots_) + bytes_of(beside_) +
         bytes_of(seen_) + bytes_of(last_) + bytes_of(clearances_) + bytes_of(facing_) +
         bytes_of(at_one_);
}

}  // namespace weft
