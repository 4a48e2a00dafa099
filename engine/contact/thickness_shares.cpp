#include "engine/contact/thickness_shares.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

BodyClearance clearance_of(const BodyClock& clock, std::size_t body, Vector x, double radius,
                           SubstepMoment when) {
  const bool starts = when == SubstepMoment::start;
  const reference::BodyMotion& motion = clock.motions()[body];
  const reference::Placement& at = starts ? motion.from : motion.to;
  const reference::Gap gap = gap_of(*motion.form, 0, at.from_place(x));
  return {static_cast<std::uint32_t>(body), at.turned(gap.normal), gap.gap,
          motion.thickness + radius, starts ? motion.velocity_at(x) : Vector{}};
}

void ThicknessShares::begin(std::size_t slots) {
  entries_.clear();
  first_.assign(slots, kNoIndex);
}

void ThicknessShares::begin_substep() {
  for (const Entry& entry : entries_) first_[entry.slot] = kNoIndex;
  entries_.clear();
}

void ThicknessShares::share(const BodyClearance& a, const BodyClearance& b, double dt_substep,
                            std::span<const std::uint32_t> slots) {
  if (dot(a.normal, b.normal) > -tuning::kAgainst) return;
  const double asked = a.thickness + b.thickness;
  const double speed = dot(a.normal, a.velocity) + dot(b.normal, b.velocity);
  const double closes = speed == 0 ? 0 : dt_substep * speed;  // dt_substep may be infinite
  const double missing = asked - (a.distance + b.distance) + closes;
  if (!(missing > 0)) return;
  const double retreat = std::clamp(closes, 0.0, missing);
  for (const BodyClearance& clearance : {a, b}) {
    const double share = asked > 0 ? clearance.thickness / asked : 0.5;
    for (const std::uint32_t slot : slots)
      add(slot, clearance.body, {share * missing, share * retreat});
  }
}

void ThicknessShares::share(std::span<const BodyClearance> clearances, double dt_substep,
                            std::uint32_t slot) {
  for (std::size_t i = 0; i < clearances.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) share(clearances[k], clearances[i], dt_substep, {&slot, 1});
  }
}

/// The largest of several counts.
void ThicknessShares::add(std::uint32_t slot, std::uint32_t body, const Thinning& thinning) {
  for (std::uint32_t i = first_[slot]; i != kNoIndex; i = entries_[i].next) {
    if (entries_[i].body != body) continue;
    if (thinning.by > entries_[i].thinning.by) entries_[i].thinning = thinning;
    return;
  }
  entries_.push_back({slot, body, first_[slot], thinning});
  first_[slot] = static_cast<std::uint32_t>(entries_.size() - 1);
}

ThicknessShares::Thinning ThicknessShares::of(std::uint32_t slot, std::uint32_t body) const {
  if (entries_.empty()) return {};
  for (std::uint32_t i = first_[slot]; i != kNoIndex; i = entries_[i].next) {
    if (entries_[i].body == body) return entries_[i].thinning;
  }
  return {};
}

std::size_t ThicknessShares::bytes() const { return bytes_of(first_) + bytes_of(entries_); }

}  // namespace weft
