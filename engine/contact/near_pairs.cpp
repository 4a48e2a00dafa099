#include "engine/contact/near_pairs.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

void NearPairs::add(const Pair& pair, const std::array<std::uint32_t, 4>& points, Vector normal,
                    double thickness, bool is_under) {
  const std::size_t lane = list.size() % kLanes;
  if (lane == 0) {
    sides.emplace_back();
    turned.push_back(0);
  }
  list.add(pair, points);
  sides.back().used |= 1u << lane;
  sides.back().thickness[lane] = static_cast<float>(thickness);
  if (pair.is_turned()) turned.back() = static_cast<std::uint16_t>(turned.back() | 1u << lane);
  states.push_back({.thickness = thickness});
  set_under(list.size() - 1, is_under);
  set_normal(list.size() - 1, normal);
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

}  // namespace weft
