/// Points of touching pairs as lanes have them in a sweep (kernels/simd/touch_data.h): each is read
/// when it is first asked for, and written once it was pushed.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/contact/scene.h"
#include "kernels/simd/touch_data.h"

namespace weft {

class SweptPoints {
 public:
  /// Of an interval.
  void begin(const ContactPoints& points);
  simd::TouchedPoints in_lanes(ContactPoints& points) {
    return {points.places(), moves_.data(), speeds_.data(), came_out_.data(), points.unit()};
  }
  void read(const ContactScene& scene, std::uint32_t point) {
    if (states_[point] == State::unknown) read_now(scene, point);
  }
  /// Lanes have pushed it.
  void mark_pushed(std::uint32_t point) { states_[point] = State::pushed; }
  /// Where lanes have pushed it.
  void write(const ContactScene& scene, std::uint32_t point);
  /// All of them. A sweep is over.
  void end(const ContactScene& scene);
  /// It was moved beside lanes.
  void forget(std::uint32_t point) { states_[point] = State::unknown; }
  std::size_t bytes() const;

 private:
  enum class State : std::uint8_t { unknown, read, pushed };
  void read_now(const ContactScene& scene, std::uint32_t point);

  kernels::AlignedVector<float> moves_, speeds_, came_out_;
  std::vector<State> states_;        // per point
  std::vector<std::uint32_t> read_;  // points, perhaps more than once
};

}  // namespace weft
