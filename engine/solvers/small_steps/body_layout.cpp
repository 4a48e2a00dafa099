#include "engine/solvers/small_steps/body_layout.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

using kernels::kLanes;

/// The place of the first particle of a block, and the lane.
struct Place {
  std::uint32_t first = 0, lane = 0, slot = 0;
};

Place find_place(const YarnPlaces& places, std::uint32_t slot) {
  if (!places.woven()) return {slot / kLanes * kLanes * 4, slot % kLanes, slot};
  const std::uint32_t place = places.of(slot), lane = place % simd::kRowFloats;
  return {place - lane, lane, slot};
}

}  // namespace

std::vector<double> shortest_lengths(const Model& model) {
  std::vector<double> shortest(model.slots(), std::numeric_limits<double>::infinity());
  const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
    for (const std::uint32_t slot : {a, b}) shortest[slot] = std::min(shortest[slot], length);
  };
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.size(); ++c) add(s.a[c], s.b[c], s.rest_length[c]);
  model.membrane.for_each_side(add);
  return shortest;
}

BodyLayout make_body_layout(const Model& model, const YarnPlaces& places, double far) {
  std::vector<Place> all;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (model.inverse_mass[slot] > 0) all.push_back(find_place(places, slot));
  }
  std::ranges::sort(all, {}, &Place::first);
  const std::vector<double> shortest = shortest_lengths(model);
  BodyLayout layout;
  layout.place_of.assign(model.slots(), kNoIndex);
  for (const Place& place : all) {
    if (layout.blocks.empty() || layout.blocks.back().place != place.first) {
      layout.blocks.push_back({});
      layout.blocks.back().place = place.first;
      std::ranges::fill(layout.blocks.back().far, std::numeric_limits<float>::infinity());
      layout.slot_at.resize(layout.slot_at.size() + kLanes, kNoIndex);
    }
    simd::BodyBlock& block = layout.blocks.back();
    const std::size_t at = layout.slot_at.size() - kLanes + place.lane;
    layout.slot_at[at] = place.slot;
    layout.place_of[place.slot] = static_cast<std::uint32_t>(at);
    block.mass[place.lane] = static_cast<float>(model.mass[place.slot]);
    if (model.has_spheres())
      block.radius[place.lane] = static_cast<float>(model.radius[place.slot]);
    const auto most = static_cast<float>(far * shortest[place.slot]);
    block.far[place.lane] = most * most;
  }
  return layout;
}

std::size_t BodyLayout::bytes() const {
  return bytes_of(blocks) + bytes_of(slot_at) + bytes_of(place_of);
}

}  // namespace weft
