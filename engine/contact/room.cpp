#include "engine/contact/room.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

Claim claim_of(const BodyClock& clock, std::size_t body, Vector x, double radius,
               SubstepMoment when) {
  const bool starts = when == SubstepMoment::start;
  const reference::BodyMotion& motion = clock.motions()[body];
  const reference::Placement& at = starts ? motion.from : motion.to;
  const reference::Gap gap = gap_of(motion.solid, 0, at.from_place(x));
  return {static_cast<std::uint32_t>(body), at.turned(gap.normal), gap.gap,
          motion.thickness + radius, starts ? motion.velocity_at(x) : Vector{}};
}

void Room::begin(std::size_t slots) {
  entries_.clear();
  first_.assign(slots, kNoIndex);
}

void Room::begin_substep() {
  for (const Entry& entry : entries_) first_[entry.slot] = kNoIndex;
  entries_.clear();
}

void Room::share(const Claim& a, const Claim& b, double h, std::span<const std::uint32_t> slots) {
  if (dot(a.normal, b.normal) > -tuning::kAgainst) return;
  const double asked = a.thickness + b.thickness;
  const double closes = h * (dot(a.normal, a.velocity) + dot(b.normal, b.velocity));
  const double missing = asked - (a.distance + b.distance) + closes;
  if (!(missing > 0)) return;
  const double retreat = std::clamp(closes, 0.0, missing);
  for (const Claim& claim : {a, b}) {
    const double share = asked > 0 ? claim.thickness / asked : 0.5;
    for (const std::uint32_t slot : slots)
      add(slot, claim.body, {share * missing, share * retreat});
  }
}

void Room::share(std::span<const Claim> claims, double h, std::uint32_t slot) {
  for (std::size_t i = 0; i < claims.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) share(claims[k], claims[i], h, {&slot, 1});
  }
}

/// The one that yields most of several counts.
void Room::add(std::uint32_t slot, std::uint32_t body, const Yield& yield) {
  for (std::uint32_t i = first_[slot]; i != kNoIndex; i = entries_[i].next) {
    if (entries_[i].body != body) continue;
    if (yield.by > entries_[i].yield.by) entries_[i].yield = yield;
    return;
  }
  entries_.push_back({slot, body, first_[slot], yield});
  first_[slot] = static_cast<std::uint32_t>(entries_.size() - 1);
}

Room::Yield Room::of(std::uint32_t slot, std::uint32_t body) const {
  if (entries_.empty()) return {};
  for (std::uint32_t i = first_[slot]; i != kNoIndex; i = entries_[i].next) {
    if (entries_[i].body == body) return entries_[i].yield;
  }
  return {};
}

std::size_t Room::bytes() const { return bytes_of(first_) + bytes_of(entries_); }

}  // namespace weft
