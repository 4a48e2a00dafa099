/// The places of a cloth's sliders on their rails (Slider).
#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/saving/archive.h"
#include "engine/solvers/small_steps/sliders.h"

namespace weft {

void visit_fields(Is<reference::RailPlace> auto& place, auto& archive) {
  auto& [piece, share] = place;
  archive(piece, share);
}

class Sliders {
 public:
  Sliders() = default;
  explicit Sliders(const Model& model) : places_(model.sliders.size()) {}

  /// Positions were given: each is at the nearest point of all its rail.
  void begin(const Model& model, const kernels::Vectors& x);
  /// A step was done.
  void take(std::span<const reference::RailPlace> places) {
    places_.assign(places.begin(), places.end());
  }

  std::span<const reference::RailPlace> places() const { return places_; }
  std::size_t bytes() const { return bytes_of(places_); }
  friend void visit_fields(Is<Sliders> auto& sliders, auto& archive) {
    auto& [places] = sliders;
    archive(places);
  }
  /// Whether those that were read are the model's.
  bool fit(const Model& model) const;

 private:
  std::vector<reference::RailPlace> places_;
};

/// m, the largest distance from a rail at x, near `places`.
double largest_rail_gap(const Model& model, std::span<const reference::RailPlace> places,
                        const kernels::Vectors& x);

}  // namespace weft
