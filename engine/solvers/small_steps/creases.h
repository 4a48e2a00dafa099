/// Hinges that yield (BendingElement in weft/scene.h), in small steps. At the end of each substep
/// in which bending was solved (bending_frame.h) the rest angle of a hinge that is bent too far
/// follows it, on either backend alike. Positions stay, so the energy of bending falls. Between two
/// such moments the law is that of folds at rest, which a substep solves as it does others.
///
/// Elements that meet at an edge's end yield together: each knows only the part of the curvature
/// that is across its edge, and all of them store
///
///     k / 2 (Kxx^2 + Kyy^2 + 2 Kxy^2)     per area, of the stiffness k and the curvature K
///
/// as a material does. So cloth yields at the same curvature in all directions, and all of K is
/// scaled by one factor: the return to the yield surface is radial (Simo and Hughes, "Computational
/// Inelasticity", 1998).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/model/bending_element.h"
#include "engine/model/model.h"
#include "kernels/reference/bending.h"

namespace weft {

/// The hinges of a model that yield.
struct CreaseLayout {
  struct Hinge {
    std::uint32_t element = 0;             // in the model's bending
    std::array<std::uint32_t, 2> place{};  // of the ends of its edge
    std::array<double, 2> share{};         // of its energy
    double softness = 0;                   // s^2, compliance / W
  };
  std::vector<Hinge> hinges;
  std::vector<double> capacity;  // J, per place: the sum of shares at which elements yield

  std::size_t bytes() const { return bytes_of(hinges) + bytes_of(capacity); }
};

/// Ends of edges are places: one for each particle, and for each layer of elements over the same
/// particles.
CreaseLayout make_crease_layout(const Model& model);

class CreaseThreads {
 public:
  CreaseThreads(const Model& model, const CreaseLayout& layout)
      : model_(model),
        layout_(layout),
        bent_(layout.hinges.size()),
        stored_(layout.capacity.size()) {}

  bool empty() const { return layout_.hinges.empty(); }
  /// A frame. creases: of all elements of the description. set_fold(element, m).
  template <class SetFold>
  void begin(std::span<const Crease> creases, SetFold&& set_fold) {
    creases_.assign(creases.begin(), creases.end());
    for (std::size_t i = 0; i < layout_.hinges.size(); ++i) {
      bent_[i].fold = fold_of(layout_.hinges[i]);
      set_fold(layout_.hinges[i].element, bent_[i].fold);
    }
  }
  /// The end of a substep. points: difference(a, b), as for constraints. resolved: 1/s^2, as
  /// reference::energy has it. Returns the energy that was lost, J.
  template <class Points, class SetFold>
  double yield(const Points& points, double resolved, SetFold&& set_fold) {
    measure(points);
    double lost = 0;
    for (std::size_t i = 0; i < layout_.hinges.size(); ++i) {
      const CreaseLayout::Hinge& hinge = layout_.hinges[i];
      if (!follow(i)) continue;
      const double before = bent_[i].fold, now = fold_of(hinge);
      bent_[i].fold = now;
      const double part = std::min(1.0, resolved * hinge.softness);
      lost += part * stiffness(hinge) * (before - now) * (0.5 * (before + now) - bent_[i].g);
      set_fold(hinge.element, now);
    }
    return lost;
  }

  std::span<const Crease> creases() const { return creases_; }
  std::size_t bytes() const { return bytes_of(bent_) + bytes_of(stored_) + bytes_of(creases_); }

 private:
  struct Bent {
    double by = 0;    // rad, beyond its rest
    double g = 0;     // m, d along n
    double fold = 0;  // m, at rest
  };

  const BendingStore::Yielding& law(const CreaseLayout::Hinge& hinge) const {
    return model_.bending.yielding[hinge.element];
  }
  double stiffness(const CreaseLayout::Hinge& hinge) const {
    return 1 / model_.bending.compliance[hinge.element];
  }
  Crease& crease(const CreaseLayout::Hinge& hinge) {
    return creases_[model_.bending.described[hinge.element]];
  }
  double fold_of(const CreaseLayout::Hinge& hinge) {
    return reference::fold_of(law(hinge).arm, crease(hinge).angle);
  }

  /// How far hinges are bent, and what the elements at each place store.
  template <class Points>
  void measure(const Points& points) {
    std::fill(stored_.begin(), stored_.end(), 0.0);
    for (std::size_t i = 0; i < layout_.hinges.size(); ++i) {
      const CreaseLayout::Hinge& hinge = layout_.hinges[i];
      reference::BendingElement e = element_of(model_.bending, hinge.element);
      std::array<kernels::Vector, 4> x{};
      for (std::uint32_t k = 1; k < 4; ++k) x[k] = points.difference(e.slots[k], e.slots[0]);
      e.slots = {0, 1, 2, 3};
      const reference::Hinge now = reference::hinge_of(e, x);
      const double by = reference::angle_of(now) - crease(hinge).angle;
      bent_[i].by = std::isfinite(by) ? by : 0;
      bent_[i].g = now.g;
      const double arm = law(hinge).arm * bent_[i].by;
      for (std::size_t k = 0; k < 2; ++k)
        stored_[hinge.place[k]] += hinge.share[k] * 0.5 * stiffness(hinge) * arm * arm;
    }
  }
  /// Returns whether it yields.
  bool follow(std::size_t i) {
    const CreaseLayout::Hinge& hinge = layout_.hinges[i];
    double square = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t place = hinge.place[k];
      if (hinge.share[k] > 0) square += hinge.share[k] * stored_[place] / layout_.capacity[place];
    }
    Crease& own = crease(hinge);
    const double hardening = law(hinge).hardening, most = 1 + hardening * own.worked;
    if (!(square > most * most)) return false;
    const double far = std::sqrt(square);
    own.angle += (1 - most / far) / (1 + hardening) * bent_[i].by;
    own.worked =
        std::min(own.worked + (far - most) / (1 + hardening), std::numeric_limits<double>::max());
    return true;
  }

  const Model& model_;
  const CreaseLayout& layout_;
  std::vector<Bent> bent_;      // per hinge
  std::vector<double> stored_;  // J, per place
  std::vector<Crease> creases_;
};

}  // namespace weft
