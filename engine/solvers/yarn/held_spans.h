/// What taut spans of yarns keep.
///
/// A span that is as long as its ends are apart can only be straight, and its constraints depend on
/// each other there. With a sag s it is longer by the strain e = 8/3 (s / L)^2: a Newton step
/// halves s, and however little strain it takes back, it moves the span by s / 2, which becomes a
/// speed of s / (2 h). (A sheet of 40 x 40 that hangs by two corners, as far apart as they are in
/// the sheet: 1 % of strain is a sag of 6 cm; 60 ms a frame in sweeps that noise calls for.)
///
/// So a taut span, one that the strain which yarns may leave could straighten, is as long as a
/// substep predicts it to be, and only what is out by more than most of that strain is taken back.
/// It hangs by what is tolerated, and its sag with it. (0.9 ms a frame.) All of its links are
/// stretched alike: a straight one that keeps what each has at the start of the substep hardly
/// comes to sag (banner, 20 x 20: 210 iterations a frame instead of 13). But where chords join its
/// particles (bending edges) each link keeps what it has at the start, or it would disagree with
/// them (16 x 16: 1500 iterations a frame instead of 30). So it is where sweeps have left more
/// strain than yarns would, here and there (10 kg on a taut sheet of 40 x 40: a step of 2.4 million
/// iterations), and in scenes with spheres: what hangs by all that it may gives way less to what
/// lands on it.
///
/// Not where it is braced, most of its links sides of triangles: these carry it as well (a sheet of
/// triangles that hangs by two corners, 40 x 40: 3.4 ms a frame, 10 if it kept lengths).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/yarn/yarn_spans.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

struct YarnLayout;

/// What rows are like while taut spans are held.
class HeldSpans {
 public:
  /// usual: the strain that yarns leave, if nothing is held; tolerance: no less. may_stretch: spans
  /// may be as long as predicted; else each of their links as long as at the start of a substep.
  HeldSpans(const YarnLayout& layout, double usual, double tolerance, bool may_stretch);

  /// Holds the spans that are taut with their ends as in x, the prediction. Each may leave `usual`
  /// beyond what its ends are too far apart or, if a link is strained by more at the start of the
  /// substep, that; no more than the tolerance. Up to most of it it is as long as in x. Ends that
  /// are too far apart for the tolerance are no reason.
  void hold(kernels::VectorsView start, kernels::VectorsView x, Team& team);
  void release() { may_leave_ = 0; }

  bool holds() const { return may_leave_ > 0; }
  /// While it holds: the strain that may be left, and what of it is up to the solver; the rest is
  /// in the lengths of the spans.
  double may_leave() const { return may_leave_; }
  double solver_may_leave() const { return may_leave_ - kept_; }
  const std::uint32_t* kind() const { return kind_.data(); }
  const simd::YarnRow* kinds() const { return kinds_.data(); }
  std::size_t bytes() const;

 private:
  static constexpr double kKept = 0.8;

  struct Span {
    bool is_taut = false;
    bool is_quiet = true;  // if it is taut: no link is strained by more than is usual
    double may_leave = 0, kept = 0;
  };
  Span judge(const YarnSpan& span, kernels::VectorsView start, kernels::VectorsView x) const;
  double largest_strain(const YarnSpan& span, kernels::VectorsView x) const;
  void stretch_alike(const YarnSpan& span, kernels::VectorsView x, double most);
  void keep_each(const YarnSpan& span, kernels::VectorsView x, double most);
  void give_back(const YarnSpan& span);
  template <class Stretch>
  void stretch(const YarnSpan& span, Stretch&& stretch_of);
  double rest_length(const YarnSpan& span, std::uint32_t row) const;

  const YarnLayout& layout_;
  const double usual_, tolerance_;
  const bool may_stretch_;
  double may_leave_ = 0, kept_ = 0;  // by all of them
  std::vector<std::uint32_t> kind_;  // as the layout's; rows of spans have their own
  kernels::AlignedVector<simd::YarnRow> kinds_;
  std::vector<Span> spans_;
};

}  // namespace weft
