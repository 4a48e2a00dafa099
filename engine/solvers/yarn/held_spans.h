/// Taut spans of yarns, and the lengths that the yarn solver gives them.
///
/// A span whose length equals the distance of its ends can only be straight, and there its
/// constraints are linearly dependent. With a sag s it is longer than that distance, by the strain
/// e = 8/3 (s / L)^2. A Newton step for this equation halves s: however little strain it removes,
/// it moves the span by s / 2, which becomes a speed of s / (2 h).
///
/// A span is taut if the distance of its ends differs from its length by no more than the strain
/// that the solver may leave. During a substep the rest lengths of such a span are those of the
/// prediction, clamped to most of that strain (tuning::kHeldShare), and the solver removes only
/// what lies beyond them: the span hangs by the tolerated strain, and its sag stays. All of its
/// links are stretched by the same ratio, since a straight span whose links keep the lengths that
/// they have at the start of the substep hardly begins to sag.
///
/// The links keep those lengths nevertheless in three cases: where constraints other than the links
/// join the particles of the span (bending edges), because a common ratio would contradict these;
/// where a link begins the substep with more strain than the yarn solver leaves; and in scenes with
/// spheres, because a span that hangs by all of its permitted strain gives way less to a sphere
/// that lands on it.
///
/// A span is not held where it is braced, which means that more than half of its links are sides of
/// triangles: the triangles carry it as well. Models with springs have no spans.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/yarn/yarn_spans.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

struct YarnLayout;

/// The kinds of rows (lengths and masses) that the solver works with while taut spans are held.
class HeldSpans {
 public:
  /// usual: the strain that the solver leaves if no span is held. It does not exceed the tolerance.
  /// may_stretch: the links of a span may share the predicted length; otherwise each keeps its
  /// length at the start of a substep.
  HeldSpans(const YarnLayout& layout, double usual, double tolerance, bool may_stretch);

  /// Holds the spans that are taut when their ends are where the prediction x has them. The strain
  /// that a span may leave is `usual` plus what its ends are too far apart, or the largest strain
  /// of its links at the start of the substep if that is more, and never more than the tolerance. A
  /// span whose ends are too far apart for the tolerance is not held.
  void hold(kernels::VectorsView start, kernels::VectorsView x, Team& team);
  void release() { may_leave_ = 0; }

  bool holds() const { return may_leave_ > 0; }
  /// While spans are held: the strain that may be left, and the part of it that the solver may
  /// leave. The rest is in the lengths of the spans.
  double may_leave() const { return may_leave_; }
  double solver_may_leave() const { return may_leave_ - kept_; }
  const std::uint32_t* kind() const { return kind_.data(); }
  const simd::YarnRow* kinds() const { return kinds_.data(); }
  std::size_t bytes() const;

 private:
  struct Span {
    bool is_taut = false;
    bool is_quiet = true;  // taut, and no link is strained by more than the solver leaves
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
  double may_leave_ = 0, kept_ = 0;  // the largest of all spans
  std::vector<std::uint32_t> kind_;  // that of the layout, except for rows of spans
  kernels::AlignedVector<simd::YarnRow> kinds_;
  std::vector<Span> spans_;
};

}  // namespace weft
