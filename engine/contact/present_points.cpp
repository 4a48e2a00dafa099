#include "engine/contact/present_points.h"

#include <utility>

#include "engine/bytes_of.h"

namespace weft {

using kernels::Vector;

void PresentPoints::begin_interval(std::span<const std::uint32_t> asked) {
  asked_.assign(asked.begin(), asked.end());
  are_placed_ = false;
  quads_.make_room(4 * points_.count());
  present_.make_room(points_.count());
}

void PresentPoints::place_vertices(const BodyClock& clock) {
  const double rate = 1 / clock.dt_substep();
  const bool are_placed = std::exchange(are_placed_, true);
  for (const std::uint32_t point : asked_) {
    if (points_.is_of_cloth(point)) continue;
    const ContactSurface& surface = points_.surface_of(point);
    if (are_placed && surface.stands) continue;
    const reference::BodyMotion& motion = clock.motions()[surface.body];
    const std::uint32_t vertex = point - surface.first_point;
    const Vector from = clock.vertex(surface.body, vertex, motion.from, clock.share_after(-1)),
                 to = clock.vertex(surface.body, vertex, motion.to, clock.share_after(0));
    set(point, {from, to, rate * (to - from)});
  }
}

void PresentPoints::read_cloth(const ContactParticles& cloth) {
  for (const std::uint32_t point : asked_) {
    if (points_.is_of_cloth(point)) set(point, cloth.read(point));
  }
}

std::size_t PresentPoints::bytes() const {
  return bytes_of(asked_) + bytes_of(quads_) + bytes_of(present_);
}

}  // namespace weft
