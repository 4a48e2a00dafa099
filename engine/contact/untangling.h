/// Cloth that crosses itself is pulled apart (SelfContact::untangle).
///
/// If a contour (contours.h) cuts off a part that is on the wrong side, edges and triangles are
/// pulled along the normal of the features that they cross, so that this part comes through.
/// Otherwise they are pulled along the gradient of the contour's length (Volino and
/// Magnenat-Thalmann 2006, "Resolving surface collisions through intersection contour
/// minimization").
///
/// A viscous force brings the edge to one speed relative to the triangle: it also slows down faster
/// ones. It is at most some weights of the particles, for any length of substeps, and keeps
/// momentum and angular momentum. The guard of energy knows its work.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/contact/contours.h"
#include "engine/contact/scene.h"

namespace weft {

class Untangling {
 public:
  /// Begins an interval. crossing: as Contours::find has it.
  void begin_interval(const ContactPoints& points, const std::vector<std::uint64_t>& crossing);
  /// Nothing is drawn in this interval.
  void leave() { pulls_.clear(); }
  /// Begins a frame.
  void begin() { work_ = 0, is_begun_ = false, leave(); }
  /// When a substep is predicted.
  void pull(const ContactScene& scene);
  /// Before the next substep, or after the last.
  void end_substep(const ContactParticles& particles);
  /// J, in the frame.
  double work() const { return work_; }
  std::size_t bytes() const;

 private:
  /// An edge, drawn from a triangle.
  struct Pull {
    std::array<std::uint32_t, 5> points{};
    std::array<double, 5> weight{};
    kernels::Vector along{};  // a unit vector
    double share = 1;         // of the speed
    double force = 0;         // N, in the present substep
  };
  void add(const ContactPoints& points, const Piercing& piercing);
  double way(const ContactParticles& particles, const Pull& pull) const;

  Contours contours_;
  WrongPart wrong_;
  std::vector<Pull> pulls_;
  std::vector<kernels::Vector> ways_;  // per slot, in the present substep
  double work_ = 0;
  bool is_begun_ = false;  // a substep
};

}  // namespace weft
