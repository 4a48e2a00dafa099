#include "engine/solvers/small_steps/simd_anchors.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::kLanes;
using kernels::Vector;

void set(simd::LaneVectors& v, std::size_t lane, Vector to) {
  v.x[lane] = static_cast<float>(to.x);
  v.y[lane] = static_cast<float>(to.y);
  v.z[lane] = static_cast<float>(to.z);
}

/// m. Beyond, a backstop is out of reach, or a point.
constexpr double kOutOfReach = 1e18;
float to_float(double number) { return static_cast<float>(std::min(number, kOutOfReach)); }

/// work(place in blocks and lanes, anchor)
template <class Work>
void for_each_anchor(const AnchorLayout& layout, Work&& work) {
  for (std::size_t i = 0; i < layout.anchor.size(); ++i) {
    if (layout.anchor[i] != kNoIndex) work(i, layout.anchor[i]);
  }
}

}  // namespace

SimdAnchors::SimdAnchors(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      layout_(model.small_steps().anchors),
      table_(table),
      clock_(model.anchors),
      blocks_(layout_.place.size()),
      backstops_(layout_.backstops) {
  for (AtLimit* mask : {&at_limit_, &before_, &held_, &arrived_, &moved_})
    mask->resize(blocks_.size());
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();  // nobody is beyond that
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i].place = layout_.place[i];
    blocks_[i].backstop = layout_.backstop[i];
    std::ranges::fill(blocks_[i].most, kNone);
    std::ranges::fill(blocks_[i].far, kNone);
  }
  const double strain = tuning::kLocalShare * settings.tolerance;
  for_each_anchor(layout_, [&](std::size_t i, std::uint32_t anchor) {
    simd::AnchorBlock& block = blocks_[i / kLanes];
    const reference::AnchorLimits& limits = model.anchors.limits[anchor];
    const auto far = static_cast<float>(strain * layout_.shortest[anchor]);
    block.most[i % kLanes] = static_cast<float>(limits.most);
    block.far[i % kLanes] = far * far;
    if (!limits.has_backstop) return;
    simd::BackstopBlock& backstop = backstops_[static_cast<std::size_t>(block.backstop)];
    backstop.distance[i % kLanes] = to_float(limits.distance);
    backstop.curvature[i % kLanes] = to_float(limits.curvature);
  });
}

/// Anchors that move push at what they hold, at first in each frame.
void SimdAnchors::begin(const AnchorTravel& travel, double h, int substeps,
                        std::span<const std::uint16_t> before) {
  if (empty()) return;
  clock_.begin(travel, h, substeps);
  std::ranges::fill(at_limit_, std::uint16_t{0});
  if (!before.empty() && !travel.moving) std::ranges::copy(before, at_limit_.begin());
  if (travel.limited || limited_) write_limits();
  limited_ = travel.limited;
  write_backstops();
}

/// Where a substep ends. Anchors that have lost their backstop have it out of reach.
void SimdAnchors::write_limits() {
  for_each_anchor(layout_, [&](std::size_t i, std::uint32_t anchor) {
    const reference::AnchorLimits limits = clock_.limits(anchor);
    simd::AnchorBlock& block = blocks_[i / kLanes];
    block.most[i % kLanes] = static_cast<float>(limits.most);
    if (!model_.anchors.limits[anchor].has_backstop) return;
    backstops_[static_cast<std::size_t>(block.backstop)].distance[i % kLanes] =
        to_float(limits.has_backstop ? limits.distance : kOutOfReach);
  });
}

void SimdAnchors::write_backstops() {
  const AnchorTravel& travel = clock_.travel();
  if (backstops_.empty()) return;
  for_each_anchor(layout_, [&](std::size_t i, std::uint32_t anchor) {
    if (!model_.anchors.limits[anchor].has_backstop) return;
    simd::BackstopBlock& backstop =
        backstops_[static_cast<std::size_t>(blocks_[i / kLanes].backstop)];
    const Vector from = travel.from[anchor].normal;
    set(backstop.normal, i % kLanes, from);
    set(backstop.turn, i % kLanes, travel.to[anchor].normal - from);
  });
}

void SimdAnchors::measure_base(const float* base) {
  const AnchorTravel& travel = clock_.travel();
  const YarnPlaces& places = model_.small_steps().places();
  const std::size_t next = places.stride;
  for_each_anchor(layout_, [&](std::size_t i, std::uint32_t anchor) {
    simd::AnchorBlock& block = blocks_[i / kLanes];
    const float* at = base + places.of(model_.anchors.slot[anchor]);
    const Vector from = travel.from[anchor].point, origin{at[0], at[next], at[2 * next]};
    set(block.point, i % kLanes, from - origin);
    set(block.way, i % kLanes, travel.to[anchor].point - from);
  });
}

void SimdAnchors::advance() {
  if (empty()) return;
  clock_.advance();
  if (clock_.travel().limited) write_limits();
  before_.swap(at_limit_);
  std::ranges::fill(at_limit_, std::uint16_t{0});
}

void SimdAnchors::hold(const simd::Flight& flight, float rate, Team& team) {
  const simd::AnchorSolve hold{.flight = flight,
                               .blocks = blocks_.data(),
                               .backstops = backstops_.data(),
                               .at_limit = held_.data(),
                               .moved = moved_.data(),
                               .woven = model_.small_steps().places().woven(),
                               .rate = rate,
                               .share = static_cast<float>(clock_.share()),
                               .per_second = static_cast<float>(clock_.per_second())};
  team.for_each_share(blocks_.size(), [&](std::size_t first, std::size_t last) {
    table_.hold_anchors(hold, first, last);
  });
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const std::uint32_t known = at_limit_[i] | std::uint32_t{before_[i]};
    arrived_[i] = static_cast<std::uint16_t>(held_[i] & ~known);
    at_limit_[i] = static_cast<std::uint16_t>(at_limit_[i] | held_[i]);
  }
}

std::size_t SimdAnchors::bytes() const {
  return bytes_of(blocks_) + bytes_of(backstops_) + 5 * bytes_of(at_limit_);
}

}  // namespace weft
