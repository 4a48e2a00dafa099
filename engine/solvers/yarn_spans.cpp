#include "engine/solvers/yarn_spans.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/bytes_of.h"
#include "engine/model.h"
#include "engine/ordering/incidence.h"
#include "engine/solvers/yarn_layout.h"

namespace weft {
namespace {

constexpr std::size_t kSpans = 16;  // that a thread takes at a time
constexpr double kNotTaut = -1;

double distance(kernels::VectorsView x, std::uint32_t a, std::uint32_t b) {
  const kernels::Vector d = x[a] - x[b];
  return std::sqrt(dot(d, d));
}

std::vector<Link> all_links(const ConstraintStore& store) {
  std::vector<Link> links;
  links.reserve(store.size());
  for (std::size_t c = 0; c < store.size(); ++c) links.push_back({store.a[c], store.b[c]});
  return links;
}

/// Counts the links of a stretch whose ends have a neighbour in common that is not in it.
class Triangles {
 public:
  explicit Triangles(const Model& model)
      : links_(all_links(model.constraints)),
        incidence_(links_at(model.slots(), links_)),
        met_(model.slots(), kNever),
        inside_(model.slots(), kNever) {}

  std::size_t along(std::span<const std::uint32_t> slots) {
    std::size_t triangles = 0;
    const std::uint32_t began = ++time_;
    for (const std::uint32_t slot : slots) inside_[slot] = began;
    for (std::size_t k = 0; k + 1 < slots.size(); ++k) {
      ++time_;
      for (const std::uint32_t link : incidence_[slots[k]]) met_[other(link, slots[k])] = time_;
      const auto joins = [&](std::uint32_t link) {
        const std::uint32_t slot = other(link, slots[k + 1]);
        return met_[slot] == time_ && inside_[slot] != began;
      };
      if (std::ranges::any_of(incidence_[slots[k + 1]], joins)) ++triangles;
    }
    return triangles;
  }

 private:
  std::uint32_t other(std::uint32_t link, std::uint32_t slot) const {
    return other_end(links_[link], slot);
  }

  static constexpr std::uint32_t kNever = 0;
  std::vector<Link> links_;
  Lists incidence_;
  std::vector<std::uint32_t> met_;     // per slot: when a link led there
  std::vector<std::uint32_t> inside_;  // per slot: when it was last in a stretch
  std::uint32_t time_ = kNever;
};

}  // namespace

void leave_out_braced(const Model& model, YarnLayout& layout) {
  if (layout.spans.empty()) return;
  Triangles triangles(model);
  std::erase_if(layout.spans, [&](const YarnSpan& span) {
    const std::size_t links = span.last_row - span.row;
    return 2 * triangles.along(std::span(layout.span_slots).subspan(span.particle, links + 1)) >
           links;
  });
}

HeldSpans::HeldSpans(const YarnLayout& layout) : layout_(layout) {
  if (layout.spans.empty()) return;
  kind_ = layout.kind;
  kinds_ = layout.kinds;
  strain_.resize(layout.spans.size());
  for (const YarnSpan& span : layout.spans) {
    for (std::uint32_t row = span.row; row < span.last_row; ++row) {
      if (kind_[row] >= layout.kinds.size()) continue;  // it has its own
      kinds_.push_back(layout.kinds[layout.kind[row]]);
      kind_[row] = static_cast<std::uint32_t>(kinds_.size() - 1);
    }
  }
}

bool HeldSpans::is_taut(const YarnSpan& span, kernels::VectorsView x, double usual,
                        double tolerance) const {
  const std::uint32_t* slot = &layout_.span_slots[span.particle];
  const double apart = distance(x, slot[0], slot[span.last_row - span.row]);
  return apart >= (1 - usual) * span.length && apart <= (1 + tolerance) * span.length;
}

double HeldSpans::largest_strain(const YarnSpan& span, kernels::VectorsView x) const {
  const std::uint32_t* slot = &layout_.span_slots[span.particle];
  double most = 0;
  for (std::uint32_t row = span.row; row < span.last_row; ++row, ++slot) {
    const double rest = static_cast<double>(layout_.kinds[layout_.kind[row]].rest[span.lane]);
    most = std::max(most, std::abs(distance(x, slot[0], slot[1]) / rest - 1));
  }
  return most;
}

/// Strains of up to `most`, of a span that is taut; no other is to keep any.
void HeldSpans::keep(const YarnSpan& span, kernels::VectorsView x, double most) {
  const std::uint32_t* slot = &layout_.span_slots[span.particle];
  for (std::uint32_t row = span.row; row < span.last_row; ++row, ++slot) {
    const auto rest = static_cast<double>(layout_.kinds[layout_.kind[row]].rest[span.lane]);
    const double length =
        std::clamp(distance(x, slot[0], slot[1]), (1 - most) * rest, (1 + most) * rest);
    simd::YarnRow& held = kinds_[kind_[row]];
    held.rest[span.lane] = static_cast<float>(length);
    held.square[span.lane] = held.rest[span.lane] * held.rest[span.lane];
  }
}

void HeldSpans::hold(kernels::VectorsView start, kernels::VectorsView x, double usual,
                     double tolerance, Team& team) {
  release();
  const std::vector<YarnSpan>& spans = layout_.spans;
  team.for_each_part(spans.size(), kSpans, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const bool taut = is_taut(spans[i], x, usual, tolerance);
      strain_[i] = taut ? largest_strain(spans[i], start) : kNotTaut;
    }
  });
  const double most = strain_.empty() ? kNotTaut : std::ranges::max(strain_);
  if (!(most >= 0)) return;
  may_leave_ = std::clamp(most, usual, tolerance);
  team.for_each_part(spans.size(), kSpans, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      keep(spans[i], start, strain_[i] < 0 ? 0 : kKept * may_leave_);
    }
  });
}

std::size_t HeldSpans::bytes() const {
  return bytes_of(kind_) + bytes_of(kinds_) + bytes_of(strain_);
}

}  // namespace weft
