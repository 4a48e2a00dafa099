#include <algorithm>

#include "engine/contact/look.h"
#include "engine/contact/respond.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

/// Of the four points of a pair, a bit for each.
std::uint32_t of_body(const ContactScene& scene, const std::array<std::uint32_t, 4>& points) {
  std::uint32_t bits = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    if (!scene.points.is_of_cloth(points[k])) bits |= 1u << k;
  }
  return bits;
}

/// The third corner of a triangle beside the edge that is not `own`, or a corner of the edge: that
/// stands out of nothing.
std::uint32_t across(const ContactSurface& surface, std::uint32_t edge, std::size_t which,
                     std::uint32_t own, std::uint32_t corner) {
  const std::uint32_t third = surface.triangles->opposite[edge][which];
  return third == kNoIndex || third == own ? corner : surface.first_point + third;
}
std::uint32_t across_triangle(const ContactSurface& surface, std::uint32_t triangle, std::size_t k,
                              std::uint32_t corner) {
  const std::uint32_t own = surface.triangles->triangles[triangle][(k + 2) % 3];
  const std::uint32_t edge = surface.triangles->edges_of[triangle][k];
  const std::uint32_t first = across(surface, edge, 0, own, corner);
  return first != corner ? first : across(surface, edge, 1, own, corner);
}

Vector vector_in(const simd::LaneVectors& v, std::size_t lane) {
  return {static_cast<double>(v.x[lane]), static_cast<double>(v.y[lane]),
          static_cast<double>(v.z[lane])};
}

void clear_loads(simd::TouchBlock& touch) {
  touch.impulse = touch.moment = {};
  std::fill_n(touch.work, kLanes, 0.f);
  std::fill_n(touch.friction_work, kLanes, 0.f);
}

}  // namespace

void Response::write_beside(const ContactScene& scene, NearPairs& near, std::size_t i) {
  const Pair& pair = near.list.pairs[i];
  const auto four = near.list.points(i);
  simd::TouchBlock& touch = near.touches[i / kLanes];
  const std::size_t lane = i % kLanes;
  const ContactSurface &first = scene.points.surfaces()[pair.a],
                       &second = scene.points.surfaces()[pair.b];
  touch.friction[lane] = static_cast<float>(scene.points.later(pair).friction);
  for (std::size_t k = 0; k < 4; ++k) {
    if (pair.kind == PairKind::edges) {
      touch.beside[k][lane] = k < 2 ? across(second, pair.second, k, kNoIndex, four[2])
                                    : across(first, pair.first, k - 2, kNoIndex, four[0]);
    } else {
      touch.beside[k][lane] =
          k < 3 ? across_triangle(second, pair.second, k, four[1 + (k + 1) % 3]) : four[0];
    }
  }
}

/// Whether places hold its points, and floats what it is large beside its thickness.
bool Response::fits_lanes(const ContactScene& scene, const NearPairs& near, std::size_t i) {
  const auto four = near.list.points(i);
  double largest = 0;
  for (const std::uint32_t point : four) {
    if (!scene.points.is_in_range(point)) return false;
    const Vector d = scene.points.start(point) - scene.points.start(four[0]);
    largest = std::max(largest, dot(d, d));
  }
  const double most =
      tuning::kLaneSize * static_cast<double>(near.sides[i / kLanes].thickness[i % kLanes]);
  return largest < most * most;
}

simd::PairPush Response::push_of(const ContactScene& scene, NearPairs& near, Turn turn) {
  const double surely_apart =
      std::max(tuning::kTouching, 16 * static_cast<double>(scene.points.unit()));
  return {.pairs = near.list.blocks.data(),
          .sides = near.sides.data(),
          .touches = near.touches.data(),
          .points = swept_.in_lanes(scene.points),
          .of_body = turn == Turn::points  ? 0xeu
                     : turn == Turn::edges ? 0xcu
                                           : 0x1u,
          .h = static_cast<float>(scene.clock.h()),
          .momentum_share = static_cast<float>(scene.particles.momentum_share()),
          .least_weight = static_cast<float>(tuning::kLeastTouchWeight),
          .lean = static_cast<float>(tuning::kTouchLean),
          .surely_apart = static_cast<float>(surely_apart)};
}

/// Points that pairs have which touched when the sweep began.
void Response::read_swept(const ContactScene& scene, Near& near) {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    std::ranges::fill(by_lanes_[list], std::uint16_t{0});
    for (std::size_t block = 0; block < touching_[list].size(); ++block) {
      if (touching_[list][block] == 0) continue;
      clear_loads(near[list].touches[block]);
      for_each_lane(block, touching_[list][block], [&](std::size_t i) {
        for (const std::uint32_t point : near[list].list.points(i)) swept_.read(scene, point);
      });
    }
  }
}

bool Response::push_in_lanes(const ContactScene& scene, Near& near, Turn turn) {
  const std::size_t list = list_in(turn);
  NearPairs& pairs = near[list];
  const simd::PairPush push = push_of(scene, pairs, turn);
  bool any = false;
  for (std::size_t block = 0; block < touching_[list].size(); ++block) {
    const std::uint32_t bits = touching_in(pairs, turn, list, block);
    if (bits == 0) continue;
    const std::uint32_t fit = bits & ~std::uint32_t{pairs.not_by_lanes[block]};
    const simd::PushedPairs found = table_.push_pairs(push, has_edges(list), block, fit);
    visits_ += tuning::kVisitsOfLook * static_cast<double>(kLanes);
    for_each_lane(block, found.pushed, [&](std::size_t i) {
      for (const std::uint32_t point : pairs.list.points(i)) {
        if (scene.points.inverse_mass(point) > 0) swept_.mark_pushed(point);
      }
    });
    std::uint32_t pushed = found.pushed;
    for_each_lane(block, found.undecided | (bits & ~fit), [&](std::size_t i) {
      if (resist_beside_lanes(scene, pairs, i)) pushed |= 1u << i % kLanes;
    });
    any = any || pushed != 0;
    pushed_[list][block] = static_cast<std::uint16_t>(pushed_[list][block] | pushed);
    by_lanes_[list][block] = static_cast<std::uint16_t>(by_lanes_[list][block] | found.pushed);
    pairs.touching[block] = static_cast<std::uint16_t>(pairs.touching[block] | pushed);
  }
  return any;
}

/// In double, in the midst of a sweep of lanes.
bool Response::resist_beside_lanes(const ContactScene& scene, NearPairs& near, std::size_t i) {
  const auto four = near.list.points(i);
  for (const std::uint32_t point : four) swept_.write(scene, point);
  visits_ += tuning::kVisitsOfTouch;
  const bool is_pushed = resist(scene, near, i);
  for (const std::uint32_t point : four) {
    swept_.forget(point);
    swept_.read(scene, point);
  }
  return is_pushed;
}

/// Writes what lanes have moved, and loads bodies.
void Response::end_sweep(const ContactScene& scene, Near& near) {
  are_linked_ = false;
  if (!in_lanes_) return;
  swept_.end(scene);
  for (std::size_t list = 0; list < kPairLists; ++list) {
    for (std::size_t block = 0; block < by_lanes_[list].size(); ++block) {
      for_each_lane(block, by_lanes_[list][block],
                    [&](std::size_t i) { take_load(scene, near[list], i); });
    }
  }
}

void Response::take_load(const ContactScene& scene, NearPairs& near, std::size_t i) {
  const simd::TouchBlock& touch = near.touches[i / kLanes];
  const std::size_t lane = i % kLanes;
  const auto four = near.list.points(i);
  const std::uint32_t on_body = of_body(scene, four);
  const std::uint32_t body = scene.points.later(near.list.pairs[i]).body;
  const TouchedSurface surface{.body = body, .velocity = vector_in(touch.velocity, lane)};
  for (std::size_t k = 0; k < 4; ++k) {
    if (scene.points.inverse_mass(four[k]) > 0) scene.particles.touch(four[k], surface);
  }
  if (on_body == 0) return;
  const Vector from = scene.points.to(four[static_cast<std::size_t>(std::countr_zero(on_body))]);
  const Vector impulse = vector_in(touch.impulse, lane);
  BodyImpulse& sum = scene.impulses.of_body[body];
  sum.linear = sum.linear + impulse;
  sum.angular = sum.angular + vector_in(touch.moment, lane) +
                cross(from - scene.clock.motions()[body].to.centre, impulse);
  scene.impulses.work += static_cast<double>(touch.work[lane]);
  scene.impulses.friction += static_cast<double>(touch.friction_work[lane]);
}

}  // namespace weft
