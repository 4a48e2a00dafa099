#include "engine/solvers/small_steps/anchor_layout.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/yarn/yarn_places.h"

namespace weft {
namespace {

using kernels::kLanes;

/// The block of a particle, by the place of its first, and the lane.
struct AnchorPlace {
  std::uint32_t place = 0, lane = 0, anchor = 0;
};

AnchorPlace find_place(const YarnPlaces& places, std::uint32_t slot, std::uint32_t anchor) {
  if (!places.woven()) return {slot / kLanes * kLanes * 4, slot % kLanes, anchor};
  const std::uint32_t place = places.of(slot), lane = place % simd::kRowFloats;
  return {place - lane, lane, anchor};
}

/// And the shortest sides of triangles of fabric.
std::vector<double> shortest_constraints(const Model& model) {
  std::vector<double> shortest(model.anchors.size(), std::numeric_limits<double>::infinity());
  const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
    for (const std::uint32_t slot : {a, b}) {
      const std::uint32_t anchor = model.anchors.at[slot];
      if (anchor != kNoIndex) shortest[anchor] = std::min(shortest[anchor], length);
    }
  };
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.size(); ++c) add(s.a[c], s.b[c], s.rest_length[c]);
  model.membrane.for_each_side(add);
  return shortest;
}

}  // namespace

AnchorLayout make_anchor_layout(const Model& model, const YarnPlaces& places) {
  AnchorLayout layout;
  const AnchorStore& store = model.anchors;
  if (store.size() == 0) return layout;
  std::vector<AnchorPlace> all;
  for (std::uint32_t i = 0; i < store.size(); ++i)
    all.push_back(find_place(places, store.slot[i], i));
  std::ranges::sort(all, {}, &AnchorPlace::place);
  layout.shortest = shortest_constraints(model);
  for (const AnchorPlace& at : all) {
    if (layout.place.empty() || layout.place.back() != at.place) {
      layout.place.push_back(at.place);
      layout.backstop.push_back(-1);
      layout.anchor.resize(layout.anchor.size() + kLanes, kNoIndex);
    }
    layout.anchor[layout.anchor.size() - kLanes + at.lane] = at.anchor;
    if (store.limits[at.anchor].has_backstop && layout.backstop.back() < 0)
      layout.backstop.back() = static_cast<std::int32_t>(layout.backstops++);
  }
  return layout;
}

std::size_t AnchorLayout::bytes() const {
  return bytes_of(place) + bytes_of(anchor) + bytes_of(shortest) + bytes_of(backstop);
}

}  // namespace weft
