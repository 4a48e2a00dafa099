/// Particles whose motion a body, the limit of an anchor or a rope ended in a substep: they go on
/// at first order.
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

/// A change of velocity in a moment, by other particles of the cloth.
struct Jolt {
  std::uint32_t slot = 0;
  kernels::Vector by{};
};

/// Visits each particle with the sum of its jolts, and empties the list.
template <class Visit>
void take_jolts(std::vector<Jolt>& jolts, Visit&& visit) {
  std::ranges::sort(jolts, {}, [](const Jolt& jolt) {  // so that sums depend on no other order
    return std::tuple(jolt.slot, jolt.by.x, jolt.by.y, jolt.by.z);
  });
  for (std::size_t i = 0; i < jolts.size();) {
    Jolt sum = jolts[i];
    for (++i; i < jolts.size() && jolts[i].slot == sum.slot; ++i) sum.by = sum.by + jolts[i].by;
    visit(sum);
  }
  jolts.clear();
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
