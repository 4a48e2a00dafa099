#include "engine/contact/near_pairs.h"

#include <weft/scene.h>

#include "engine/bytes_of.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

void set_bit(std::vector<std::uint16_t>& bits, std::size_t lane) {
  bits.back() = static_cast<std::uint16_t>(bits.back() | 1u << lane);
}

}  // namespace

void NearPairs::add(const Pair& pair, const std::array<std::uint32_t, 4>& points, Vector normal,
                    double thickness, bool is_under, bool is_likely) {
  const std::size_t lane = list.size() % kLanes;
  if (lane == 0) {
    sides.emplace_back();
    turned.push_back(0);
    likely.push_back(0);
  }
  list.add(pair, points);
  sides.back().used |= 1u << lane;
  sides.back().thickness[lane] = static_cast<float>(thickness);
  if (pair.is_turned()) set_bit(turned, lane);
  if (is_likely) set_bit(likely, lane);
  set_under(list.size() - 1, is_under);
  set_normal(list.size() - 1, normal);
}

void NearPairs::take(const NearPairs& from, const std::vector<std::uint32_t>& order,
                     std::uint32_t unmoved) {
  clear();
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] == kNoIndex) {
      list.leave_lane(unmoved);
      continue;
    }
    const std::size_t old = order[i];
    add(from.list.pairs[old], from.list.points(old), from.normal(old),
        static_cast<double>(from.sides[old / kLanes].thickness[old % kLanes]), from.is_under(old),
        from.has(old, from.likely));
  }
  const std::size_t blocks = list.blocks.size();
  touches.assign(blocks, {});
  touching.assign(blocks, 0);
  not_by_lanes.assign(blocks, 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t old = order[i];
    if (order[i] == kNoIndex || old / kLanes >= from.touches.size()) continue;
    set_grip(i, from.grip(old));
    if (from.is_touching(old)) set_touching(i);
  }
}

reference::Grip NearPairs::grip(std::size_t i) const {
  const simd::TouchBlock& t = touches[i / kLanes];
  const std::size_t lane = i % kLanes;
  const auto number = [&](const float(&of)[kLanes]) { return static_cast<double>(of[lane]); };
  return {number(t.pushed), number(t.held), number(t.stopped), number(t.slowed),
          number(t.came_out)};
}

void NearPairs::set_grip(std::size_t i, const reference::Grip& grip) {
  simd::TouchBlock& t = touches[i / kLanes];
  const std::size_t lane = i % kLanes;
  t.pushed[lane] = static_cast<float>(grip.pushed);
  t.held[lane] = static_cast<float>(grip.held);
  t.stopped[lane] = static_cast<float>(grip.stopped);
  t.slowed[lane] = static_cast<float>(grip.slowed);
  t.came_out[lane] = static_cast<float>(grip.came_out);
}

void NearPairs::forget_grips(std::size_t block) {
  simd::TouchBlock& t = touches[block];
  for (float* lanes : {t.pushed, t.held, t.stopped, t.slowed, t.came_out})
    std::fill_n(lanes, kLanes, 0.f);
  touching[block] = 0;
}

Vector NearPairs::normal(std::size_t i) const {
  const simd::LaneVectors& n = sides[i / kLanes].normal;
  const std::size_t lane = i % kLanes;
  return {static_cast<double>(n.x[lane]), static_cast<double>(n.y[lane]),
          static_cast<double>(n.z[lane])};
}

void NearPairs::set_normal(std::size_t i, Vector normal) {
  simd::LaneVectors& n = sides[i / kLanes].normal;
  const std::size_t lane = i % kLanes;
  n.x[lane] = static_cast<float>(normal.x);
  n.y[lane] = static_cast<float>(normal.y);
  n.z[lane] = static_cast<float>(normal.z);
}

std::size_t NearPairs::bytes() const {
  return list.bytes() + bytes_of(sides) + bytes_of(turned) + bytes_of(likely) + bytes_of(touches) +
         bytes_of(touching) + bytes_of(not_by_lanes);
}

}  // namespace weft
