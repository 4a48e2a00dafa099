#include "tools/scenes/events.h"

#include <string>

namespace weft::tools {
namespace {

/// Times that are written in few digits are no whole numbers of frames to the last bit.
constexpr double kRounding = 1e-9;

Result<void> happen(const SceneEvent& event, Cloth& cloth) {
  if (auto r = cloth.change({.fix = event.fix, .release = event.release}); !r) return r;
  if (auto r = cloth.release_seams(event.release_seams); !r) return r;
  if (auto r = cloth.close_seams(event.close_seams); !r) return r;
  for (const auto& [anchor, limit] : event.anchors) {
    if (auto r = cloth.limit_anchor(anchor, limit); !r) return r;
  }
  if (event.anchor_scale) {
    if (auto r = cloth.scale_anchors(*event.anchor_scale); !r) return r;
  }
  if (event.gravity) {
    if (auto r = cloth.set_gravity(*event.gravity); !r) return r;
  }
  return event.wind ? cloth.set_wind(*event.wind) : Result<void>{};
}

}  // namespace

Result<void> Events::happen(double begin_of_frame, Cloth& cloth, MovedPins& pins) {
  const double now = begin_of_frame + kRounding;
  for (; next_ < events_.size() && events_[next_].time <= now; ++next_) {
    const SceneEvent& event = events_[next_];
    if (auto r = tools::happen(event, cloth); !r)
      return Error{"events[" + std::to_string(next_) + "]." + r.error()};
    pins.release(event.release);
  }
  return {};
}

std::vector<SceneEvent> present_events(std::span<const SceneEvent> events, double elapsed) {
  std::vector<SceneEvent> present(events.begin(), events.end());
  for (SceneEvent& event : present) event.time -= elapsed;
  return present;
}

}  // namespace weft::tools
