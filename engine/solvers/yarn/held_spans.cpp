#include "engine/solvers/yarn/held_spans.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr std::size_t kSpans = 16;  // the number of spans that a thread takes at a time

double distance(kernels::VectorsView x, std::uint32_t a, std::uint32_t b) {
  const kernels::Vector d = x[a] - x[b];
  return std::sqrt(dot(d, d));
}

}  // namespace

HeldSpans::HeldSpans(const YarnLayout& layout, double usual, double tolerance, bool may_stretch)
    : layout_(layout), usual_(usual), tolerance_(tolerance), may_stretch_(may_stretch) {
  if (layout.spans.empty()) return;
  kind_ = layout.kind;
  kinds_ = layout.kinds;
  spans_.resize(layout.spans.size());
  for (const YarnSpan& span : layout.spans) {
    for (std::uint32_t row = span.row; row < span.last_row; ++row) {
      if (kind_[row] >= layout.kinds.size()) continue;  // another lane gave it a kind
      kinds_.push_back(layout.kinds[layout.kind[row]]);
      kind_[row] = static_cast<std::uint32_t>(kinds_.size() - 1);
    }
  }
}

double HeldSpans::rest_length(const YarnSpan& span, std::uint32_t row) const {
  return static_cast<double>(layout_.kinds[layout_.kind[row]].rest[span.lane]);
}

HeldSpans::Span HeldSpans::judge(const YarnSpan& span, kernels::VectorsView start,
                                 kernels::VectorsView x) const {
  const std::uint32_t* slot = &layout_.span_slots[span.first_slot];
  const double apart = distance(x, slot[0], slot[span.last_row - span.row]) / span.length - 1;
  if (!(apart >= -usual_ && apart <= tolerance_)) return {};
  const double least = std::max(apart + usual_, usual_), strain = largest_strain(span, start);
  const double may_leave = std::min(std::max(least, strain), tolerance_);
  const double to_sag =
      std::min(apart + tuning::kHeldShare * usual_, tolerance_ - (1 - tuning::kHeldShare) * usual_);
  return {true, strain <= least, may_leave, std::max(tuning::kHeldShare * may_leave, to_sag)};
}

double HeldSpans::largest_strain(const YarnSpan& span, kernels::VectorsView x) const {
  const std::uint32_t* slot = &layout_.span_slots[span.first_slot];
  double most = 0;
  for (std::uint32_t row = span.row; row < span.last_row; ++row, ++slot) {
    const double stretch = distance(x, slot[0], slot[1]) / rest_length(span, row);
    most = std::max(most, std::abs(stretch - 1));
  }
  return most;
}

/// Sets the length of each link. stretch_of(slots of both ends, rest length) returns its ratio to
/// the rest length.
template <class Stretch>
void HeldSpans::stretch(const YarnSpan& span, Stretch&& stretch_of) {
  const std::uint32_t* slot = &layout_.span_slots[span.first_slot];
  for (std::uint32_t row = span.row; row < span.last_row; ++row, ++slot) {
    const double rest = rest_length(span, row);
    const auto length = static_cast<float>(stretch_of(slot, rest) * rest);
    simd::YarnRow& held = kinds_[kind_[row]];
    held.rest[span.lane] = length;
    held.square[span.lane] = length * length;
  }
}

void HeldSpans::stretch_alike(const YarnSpan& span, kernels::VectorsView x, double most) {
  const std::uint32_t* slot = &layout_.span_slots[span.first_slot];
  double length = 0;
  for (std::uint32_t k = 0; k < span.last_row - span.row; ++k) {
    length += distance(x, slot[k], slot[k + 1]);
  }
  const double alike = std::clamp(length / span.length, 1 - most, 1 + most);
  stretch(span, [&](const std::uint32_t*, double) { return alike; });
}

void HeldSpans::keep_each(const YarnSpan& span, kernels::VectorsView x, double most) {
  stretch(span, [&](const std::uint32_t* slot, double rest) {
    return std::clamp(distance(x, slot[0], slot[1]) / rest, 1 - most, 1 + most);
  });
}

void HeldSpans::give_back(const YarnSpan& span) {
  stretch(span, [](const std::uint32_t*, double) { return 1.0; });
}

void HeldSpans::hold(kernels::VectorsView start, kernels::VectorsView x, Team& team) {
  release();
  const std::vector<YarnSpan>& spans = layout_.spans;
  if (spans.empty()) return;
  team.for_each_part(spans.size(), kSpans, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) spans_[i] = judge(spans[i], start, x);
  });
  may_leave_ = std::ranges::max(spans_, {}, &Span::may_leave).may_leave;
  kept_ = std::ranges::max(spans_, {}, &Span::kept).kept;
  if (!holds()) return;
  const bool alike = may_stretch_ && std::ranges::all_of(spans_, &Span::is_quiet);
  team.for_each_part(spans.size(), kSpans, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!spans_[i].is_taut)
        give_back(spans[i]);
      else if (alike && !spans[i].has_chords)
        stretch_alike(spans[i], x, spans_[i].kept);
      else
        keep_each(spans[i], start, kept_);
    }
  });
}

std::size_t HeldSpans::bytes() const {
  return bytes_of(kind_) + bytes_of(kinds_) + bytes_of(spans_);
}

}  // namespace weft
