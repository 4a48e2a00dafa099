/// Solids in closed form, in coordinates of their body: how far a point is from the surface, and
/// which way is out. How the surface moves follows from the motion of the body (bodies.h).
///
/// A new form needs gap() alone. Lanes have formulas of their own for faces and for round forms.
/// Beside all others particles are solved one after the other (kernels/simd/fields.h).
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "kernels/vectors.h"

namespace weft::reference {

using kernels::Vector;

/// How a point stands to the surface.
struct Gap {
  double gap = std::numeric_limits<double>::infinity();  // m; negative: inside
  Vector normal{};                                       // out of the solid
};

/// The surface where a particle touches it.
struct Touch {
  bool is_near = false;  // it is under the surface, or came through it
  Vector normal{};
  double gap = 0;  // m, over the surface's plane there; negative: under it
};

/// Points with normal . x < offset are inside.
struct Face {
  Vector normal{};
  double offset = 0;
};

/// All balls whose centres lie on a segment.
struct Round {
  Vector a{}, axis{};  // where it begins, and the unit vector along it
  double length = 0;   // m; 0: a ball
  double radius = 0;   // m, at a
  double taper = 0;    // by which the radius falls, per length; |taper| < 1

  double radius_at_end() const { return radius - length * taper; }
  double least_radius() const { return std::min(radius, radius_at_end()); }
  double most_radius() const { return std::max(radius, radius_at_end()); }
};

class Form {
 public:
  /// narrow: m, as far as a ball fits into any part of it. Longer ways than a quarter of that may
  /// lead through it.
  explicit Form(double narrow) : narrow_(narrow) {}
  virtual ~Form();
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;

  /// On a way of one metre the gap changes by one metre at most.
  virtual Gap gap(Vector y) const = 0;
  /// The first point of a way from y0 to y1 that is nearer than `thickness`; the end of a short
  /// way, and of one that begins there and leads out.
  virtual Touch touch(double thickness, Vector y0, Vector y1) const;
  /// m, by which both ends of a way may be moved so that it stays farther away than `thickness`;
  /// where it is not positive it may come nearer.
  virtual double clear(double thickness, Vector y0, Vector y1) const;
  /// No push out of it leads into it again.
  virtual bool is_convex() const { return false; }
  /// Those for which lanes have formulas; else there are neither.
  virtual std::span<const Face> faces() const { return {}; }
  virtual const Round* round() const { return nullptr; }

  /// m: longer ways are looked at in full.
  double short_way(double thickness) const { return (narrow_ + thickness) / 4; }

 private:
  double narrow_;
};

/// The inside of faces: of one, a half space.
class FacedForm final : public Form {
 public:
  explicit FacedForm(std::vector<Face> faces) : Form(0), faces_(std::move(faces)) {}
  /// The gap of the face that is farthest below, or least far above.
  Gap gap(Vector y) const override;
  /// The face through which the way enters the inside of all. For a way that begins there it is the
  /// face nearest to its beginning, where the way leads down from that or ends inside: a particle
  /// on a thin body, by rounding inside, does not leave it by the other side.
  Touch touch(double thickness, Vector y0, Vector y1) const override;
  /// Both ends are in front of one face by that.
  double clear(double thickness, Vector y0, Vector y1) const override;
  bool is_convex() const override { return true; }
  std::span<const Face> faces() const override { return faces_; }

 private:
  std::vector<Face> faces_;
};

class RoundForm final : public Form {
 public:
  explicit RoundForm(const Round& round) : Form(round.least_radius()), round_(round) {}
  /// The ball that is nearest to y is at the height y_axis - k d / sqrt(1 - k^2) over a, with k the
  /// taper and d the distance from the axis.
  Gap gap(Vector y) const override;
  bool is_convex() const override { return true; }
  const Round* round() const override { return &round_; }

 private:
  Round round_;
};

}  // namespace weft::reference
