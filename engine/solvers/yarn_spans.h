/// Spans: the stretches of yarns between two fixed particles.
///
/// A span that is as long as its ends are apart can only be straight, and its constraints depend on
/// each other there. With a sag s it is longer by the strain e = 8/3 (s / L)^2: a Newton step
/// halves s, and however little strain it takes back, it moves the span by s / 2, which becomes a
/// speed of s / (2 h). (A sheet of 40 x 40 that hangs by two corners, as far apart as they are in
/// the sheet: 1 % of strain is a sag of 6 cm; 60 ms a frame in sweeps that noise calls for.)
///
/// So a taut span, one that the strain which yarns may leave could straighten, keeps the lengths
/// that its constraints have at the start of a substep, and only what is out by more than most of
/// that strain is taken back. It hangs by what is tolerated, and its sag with it. (1.2 ms a frame.)
/// Not where it is braced, most of its links sides of triangles: these carry it as well (a sheet of
/// triangles that hangs by two corners, 40 x 40: 3.4 ms a frame, 10 if it kept lengths).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/solvers/team.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class Model;
struct YarnLayout;

struct YarnSpan {
  std::uint32_t row = 0, last_row = 0;  // its links; row of the layout, one past the last
  std::uint32_t lane = 0;
  std::uint32_t particle = 0;  // in YarnLayout::span_slots: of the first; of the others, behind it
  double length = 0;           // m
};

void leave_out_braced(const Model& model, YarnLayout& layout);

/// What rows are like while taut spans keep their lengths.
class HeldSpans {
 public:
  explicit HeldSpans(const YarnLayout& layout);

  /// Spans that are taut with their ends as in x keep the lengths that they have at start, up to
  /// most of `usual`, the strain that yarns may leave; up to most of `tolerance` if they are beyond
  /// that. Ends that are too far apart for the tolerance are no reason.
  void hold(kernels::VectorsView start, kernels::VectorsView x, double usual, double tolerance,
            Team& team);
  void release() { may_leave_ = 0; }

  bool holds() const { return may_leave_ > 0; }
  /// While it holds: the strain that may be left, and what of it is up to the solver; the rest is
  /// in the lengths that are kept.
  double may_leave() const { return may_leave_; }
  double solver_may_leave() const { return (1 - kKept) * may_leave_; }
  const std::uint32_t* kind() const { return kind_.data(); }
  const simd::YarnRow* kinds() const { return kinds_.data(); }
  std::size_t bytes() const;

 private:
  static constexpr double kKept = 0.8;

  bool is_taut(const YarnSpan& span, kernels::VectorsView x, double usual, double tolerance) const;
  double largest_strain(const YarnSpan& span, kernels::VectorsView x) const;
  void keep(const YarnSpan& span, kernels::VectorsView x, double most);

  const YarnLayout& layout_;
  double may_leave_ = 0;
  std::vector<std::uint32_t> kind_;  // as the layout's; rows of spans have their own
  kernels::AlignedVector<simd::YarnRow> kinds_;
  std::vector<double> strain_;  // per span; less than 0: it is not taut
};

}  // namespace weft
