/// Spans: the parts of yarns between two fixed particles. held_spans.h uses them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/lists.h"
#include "engine/ordering/ordering.h"

namespace weft {

class Model;

struct YarnSpan {
  std::uint32_t row = 0, last_row = 0;  // rows of the layout, one for each link
  std::uint32_t lane = 0;
  std::uint32_t first_slot = 0;  // where its particles begin in YarnLayout::span_slots
  bool has_chords = false;
  double length = 0;  // m
};

/// Finds what other constraints join the particles of a span. The span is given by the slots of its
/// particles.
class Braces {
 public:
  explicit Braces(const Model& model) : model_(model) {}

  /// Whether more than half of the links are sides of triangles.
  bool is_braced(std::span<const std::uint32_t> slots);
  /// Whether constraints other than the links join two particles of the span.
  bool has_chords(std::span<const std::uint32_t> slots);

 private:
  void enter(std::span<const std::uint32_t> slots);
  bool is_inside(std::uint32_t slot) const { return inside_[slot] == entered_; }
  std::uint32_t other(std::uint32_t link, std::uint32_t slot) const;

  const Model& model_;
  // Filled when a span is first asked about.
  std::vector<Link> links_;
  Lists incidence_;
  std::vector<std::uint32_t> met_;     // per slot: the last time that a link led there
  std::vector<std::uint32_t> inside_;  // per slot: the last time that it was in a span
  std::uint32_t time_ = 0, entered_ = 0;
};

}  // namespace weft
