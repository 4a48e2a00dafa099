#include "engine/step/sliders.h"

#include <algorithm>
#include <limits>

namespace weft {

namespace {

reference::RailPoint nearest_at(const Model& model, std::size_t i, reference::RailPlace from,
                                const kernels::Vectors& x) {
  const kernels::Vector own = x[model.sliders.slot[i]];
  return nearest_on_rail(model.sliders, i, from, [&](std::uint32_t slot) { return x[slot] - own; });
}

reference::RailPlace nearest_of_all(const Model& model, std::size_t i, const kernels::Vectors& x) {
  reference::RailPlace nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t piece = 0; piece < model.sliders.pieces(i); ++piece) {
    const reference::RailPoint at = nearest_at(model, i, {piece, 0.5}, x);
    const double way = length(at.way);
    if (way >= least) continue;
    least = way;
    nearest = at.place;
  }
  return nearest;
}

}  // namespace

void Sliders::begin(const Model& model, const kernels::Vectors& x) {
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = nearest_of_all(model, i, x);
}

bool Sliders::fit(const Model& model) const {
  if (places_.size() != model.sliders.size()) return false;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto& [piece, share] = places_[i];
    if (piece >= model.sliders.pieces(i) || !(share >= 0 && share <= 1)) return false;
  }
  return true;
}

double largest_rail_gap(const Model& model, std::span<const reference::RailPlace> places,
                        const kernels::Vectors& x) {
  double most = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    most = std::max(most, length(nearest_at(model, i, places[i], x).way));
  return most;
}

}  // namespace weft
