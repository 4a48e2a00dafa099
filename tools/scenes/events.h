/// What happens to the cloth of a scene at given times: pins are released, seams open, anchors let
/// go. Units are m and s.
///
/// An event happens before the first frame that begins at its time or later. Those at time 0 and
/// before are how the scene begins: where they release or fix, its positions and velocities stay.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/scenes/pin_moves.h"

namespace weft::tools {

/// New limits of one anchor.
struct LimitedAnchor {
  std::uint32_t anchor = 0;
  AnchorLimit limit{};
};

struct SceneEvent {
  double time = 0;
  std::vector<std::uint32_t> release = {};  ///< fixed particles, whose moves end with that
  std::vector<std::uint32_t> fix = {};      ///< particles
  std::vector<std::uint32_t> release_seams = {}, close_seams = {};
  std::vector<LimitedAnchor> anchors = {};
  std::optional<double> anchor_scale = {};
  std::optional<Vec3> gravity = {}, wind = {};
};

/// The events of a run of one cloth, in the order of their times.
class Events {
 public:
  explicit Events(std::span<const SceneEvent> events) : events_(events) {}
  /// Those that are due where a frame begins, and were not before. An error names the event.
  Result<void> happen(double begin_of_frame, Cloth& cloth, MovedPins& pins);
  /// How many have happened.
  std::size_t count() const { return next_; }

 private:
  std::span<const SceneEvent> events_;
  std::size_t next_ = 0;
};

/// The events of a scene that goes on after `elapsed` seconds: all times become less by that.
std::vector<SceneEvent> present_events(std::span<const SceneEvent> events, double elapsed);

}  // namespace weft::tools
