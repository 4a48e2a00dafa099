/// The sliders of small steps (kernels/reference/rails.h), one after the other, on either backend.
///
/// points: difference(a, b), start_difference(a, b) and move(slot, by) as for constraints (laws.h),
/// and touched, particles whose motion ends there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "kernels/reference/rails.h"

namespace weft {

/// The rail of a slider, as ways from its particle. difference(slot): from there to a particle.
template <class Difference>
class RailFrom {
 public:
  RailFrom(const SliderStore& sliders, std::size_t slider, const Difference& difference)
      : sliders_(sliders), slider_(slider), difference_(difference) {}

  std::uint32_t pieces() const { return sliders_.pieces(slider_); }
  bool is_closed() const { return sliders_.is_closed(slider_); }
  std::array<kernels::Vector, 4> around(std::uint32_t piece) const {
    const std::array<std::uint32_t, 4> slots = sliders_.around(slider_, piece);
    return {difference_(slots[0]), difference_(slots[1]), difference_(slots[2]),
            difference_(slots[3])};
  }

 private:
  const SliderStore& sliders_;
  const std::size_t slider_;
  const Difference& difference_;
};

/// The nearest point of the rail of a slider.
template <class Difference>
reference::RailPoint nearest_on_rail(const SliderStore& sliders, std::size_t slider,
                                     reference::RailPlace from, const Difference& difference) {
  return reference::nearest_on_rail(RailFrom<Difference>(sliders, slider, difference), from);
}

class SliderThreads {
 public:
  explicit SliderThreads(const Model& model) : model_(model), impulses_(model.sliders.size()) {}

  bool empty() const { return impulses_.empty(); }
  /// A frame. is_rough: friction counts, as it does while time passes.
  void begin(std::span<const reference::RailPlace> places, bool is_rough) {
    places_.assign(places.begin(), places.end());
    is_rough_ = is_rough;
  }

  /// The end of a sweep, or of local passes: a turn. is_first: nothing of the substep was
  /// swept before. Returns how far one was away from its rail at most, m.
  template <class Points>
  double hold(const Points& points, bool is_first) {
    if (is_first) std::ranges::fill(impulses_, Impulse{});
    double most = 0;
    for (std::size_t i = 0; i < impulses_.size(); ++i) most = std::max(most, hold_one(points, i));
    return most;
  }

  std::span<const reference::RailPlace> places() const { return places_; }
  std::size_t bytes() const { return bytes_of(impulses_) + bytes_of(places_); }

 private:
  /// The impulses of a substep, kg m: towards the rail, and along it.
  struct Impulse {
    kernels::Vector normal{};
    double friction = 0;
  };

  /// Returns how far it was away, m.
  template <class Points>
  double hold_one(const Points& points, std::size_t i) {
    const SliderStore& s = model_.sliders;
    const std::uint32_t slot = s.slot[i];
    const auto difference = [&](std::uint32_t other) { return points.difference(other, slot); };
    const reference::RailPoint at = nearest_on_rail(s, i, places_[i], difference);
    if (is_at_end(i, at.place) && dot(at.way, at.tangent) != 0) points.touched.push_back(slot);
    places_[i] = at.place;
    const std::array<std::uint32_t, 4> rail = s.around(i, at.place.piece);
    double inverse = model_.inverse_mass[slot];
    for (std::size_t k = 0; k < 4; ++k)
      inverse += at.weights[k] * at.weights[k] * model_.inverse_mass[rail[k]];
    if (inverse == 0) return 0;
    const kernels::Vector by = (1 / inverse) * at.way;
    impulses_[i].normal = impulses_[i].normal + by;
    give(points, slot, rail, at.weights, by);
    if (is_rough_ && s.friction[i] > 0) rub(points, i, rail, at, inverse);
    return length(at.way);
  }

  /// The end of a rail is a stop.
  bool is_at_end(std::size_t i, reference::RailPlace place) const {
    if (model_.sliders.is_closed(i)) return false;
    return (place.piece == 0 && place.share == 0) ||
           (place.piece + 1 == model_.sliders.pieces(i) && place.share == 1);
  }

  /// Friction holds the particle at the material of its rail as far as it can.
  template <class Points>
  void rub(const Points& points, std::size_t i, const std::array<std::uint32_t, 4>& rail,
           const reference::RailPoint& at, double inverse) {
    const SliderStore& s = model_.sliders;
    const std::uint32_t slot = s.slot[i];
    double slid = 0;  // m
    for (std::size_t k = 0; k < 4; ++k) {
      const kernels::Vector moved =
          points.difference(slot, rail[k]) - points.start_difference(slot, rail[k]);
      slid += at.weights[k] * dot(at.tangent, moved);
    }
    Impulse& own = impulses_[i];
    const double most = reference::friction_of_turn(s.friction[i], turn_at(points, i, at.place)) *
                        length(own.normal);
    const double next = std::clamp(own.friction - slid / inverse, -most, most);
    const double by = next - own.friction;
    own.friction = next;
    give(points, slot, rail, at.weights, by * at.tangent);
  }

  template <class Points>
  void give(const Points& points, std::uint32_t slot, const std::array<std::uint32_t, 4>& rail,
            const reference::RailWeights& weights, kernels::Vector impulse) const {
    points.move(slot, model_.inverse_mass[slot] * impulse);
    for (std::size_t k = 0; k < 4; ++k) {
      const double share = weights[k] * model_.inverse_mass[rail[k]];
      if (share != 0) points.move(rail[k], -share * impulse);
    }
  }

  /// rad, by which a rail that moves freely turns over the particle: between the pieces beside its
  /// own. One of fixed particles turns by itself, whatever slides on it.
  template <class Points>
  double turn_at(const Points& points, std::size_t i, reference::RailPlace place) const {
    const std::array<std::uint32_t, 4> rail = model_.sliders.around(i, place.piece);
    if (model_.inverse_mass[rail[1]] == 0 && model_.inverse_mass[rail[2]] == 0) return 0;
    if (rail[0] == rail[1] || rail[2] == rail[3]) return 0;
    const kernels::Vector before = points.difference(rail[1], rail[0]);
    const kernels::Vector after = points.difference(rail[3], rail[2]);
    return std::atan2(length(cross(before, after)), dot(before, after));
  }

  const Model& model_;
  std::vector<Impulse> impulses_;
  std::vector<reference::RailPlace> places_;
  bool is_rough_ = false;
};

}  // namespace weft
