/// Particles that a body, the limit of an anchor or a rope has stopped in a substep: they go on at
/// first order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/contact/particles.h"
#include "engine/erase_repeated.h"

namespace weft {

struct Arrival {
  std::uint32_t slot = 0;
  TouchedSurface surface{};  // of no body: an anchor's limit, or a rope
};

/// A jump of a particle's velocity, by other particles of the cloth.
struct VelocityJump {
  std::uint32_t slot = 0;
  kernels::Vector by{};
};

/// Visits each particle with the sum of its velocity_jumps, and empties the list.
template <class Visit>
void take_velocity_jumps(std::vector<VelocityJump>& velocity_jumps, Visit&& visit) {
  std::ranges::sort(velocity_jumps, {},
                    [](const VelocityJump& jump) {  // so that sums depend on no other order
                      return std::tuple(jump.slot, jump.by.x, jump.by.y, jump.by.z);
                    });
  for (std::size_t i = 0; i < velocity_jumps.size();) {
    VelocityJump sum = velocity_jumps[i];
    for (++i; i < velocity_jumps.size() && velocity_jumps[i].slot == sum.slot; ++i)
      sum.by = sum.by + velocity_jumps[i].by;
    visit(sum);
  }
  velocity_jumps.clear();
}

/// Visits the first arrival of each particle, those at bodies first, and empties the list.
template <class Visit>
void take_arrivals(std::vector<Arrival>& arrivals, Visit&& visit) {
  std::ranges::sort(arrivals, {},
                    [](const Arrival& a) { return std::tuple(a.slot, a.surface.body); });
  erase_repeated(arrivals, &Arrival::slot);
  for (const Arrival& arrival : arrivals) visit(arrival);
  arrivals.clear();
}

/// Visits each slot once, in ascending order, and empties the list.
template <class Visit>
void take_each_once(std::vector<std::uint32_t>& slots, Visit&& visit) {
  std::ranges::sort(slots);
  erase_repeated(slots);
  for (const std::uint32_t slot : slots) visit(slot);
  slots.clear();
}

}  // namespace weft
