/// Spans: the stretches of yarns between two fixed particles (held_spans.h: what for).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/lists.h"
#include "engine/ordering/ordering.h"

namespace weft {

class Model;

struct YarnSpan {
  std::uint32_t row = 0, last_row = 0;  // its links; row of the layout, one past the last
  std::uint32_t lane = 0;
  std::uint32_t first_slot = 0;  // where its particles begin in YarnLayout::span_slots
  bool has_chords = false;
  double length = 0;  // m
};

/// What else joins the particles of a span, which are given by their slots.
class Braces {
 public:
  explicit Braces(const Model& model) : model_(model) {}

  /// Whether more than half of its links are sides of triangles.
  bool is_braced(std::span<const std::uint32_t> slots);
  /// Whether constraints that are not its links join particles of it to each other.
  bool has_chords(std::span<const std::uint32_t> slots);

 private:
  void enter(std::span<const std::uint32_t> slots);
  bool is_inside(std::uint32_t slot) const { return inside_[slot] == entered_; }
  std::uint32_t other(std::uint32_t link, std::uint32_t slot) const;

  const Model& model_;
  // From when they are first wanted:
  std::vector<Link> links_;
  Lists incidence_;
  std::vector<std::uint32_t> met_;     // per slot: when a link led there
  std::vector<std::uint32_t> inside_;  // per slot: when it was last in a span
  std::uint32_t time_ = 0, entered_ = 0;
};

}  // namespace weft
