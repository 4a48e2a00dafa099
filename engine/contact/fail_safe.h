/// Stage 8 of contacts with meshes: what to do about pairs that went through each other. First they
/// are stopped where they would have met, as by inelastic blows; that may send others through each
/// other, so it is done in rounds. Then what still fails is taken along by the body as if it stuck
/// to it: a rigid impact zone (Bridson, Fedkiw and Anderson, 2002) whose motion is the body's.
#pragma once

#include "engine/contact/fail_safe_report.h"
#include "engine/contact/verification.h"

namespace weft {

/// Until all is verified, or its rounds are over. Particles whose pairs are left are told to
/// lost(slot, pair).
template <class Lost>
void stop_failures(const ContactScene& scene, const BroadPhase& broad, NarrowPhase& narrow,
                   Verification& verification, Candidates& candidates, double time,
                   FailSafeReport& report, Team& team, Lost&& lost);

namespace fail_safe {

/// time: s, of the interval.
void blow(const ContactScene& scene, const PairList& pairs, const Failure& failure, double time);
void take_along(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                double time);

}  // namespace fail_safe

template <class Lost>
void stop_failures(const ContactScene& scene, const BroadPhase& broad, NarrowPhase& narrow,
                   Verification& verification, Candidates& candidates, double time,
                   FailSafeReport& report, Team& team, Lost&& lost) {
  constexpr int kBlows = 8, kZones = 12;  // rounds
  report.failures += static_cast<int>(verification.failures().size());
  for (int round = 0; round < kBlows + kZones && !verification.failures().empty(); ++round) {
    for (const Failure& failure : verification.failures()) {
      if (round < kBlows)
        fail_safe::blow(scene, candidates[failure.list], failure, time);
      else
        fail_safe::take_along(scene, candidates[failure.list], failure, time);
    }
    if (round >= kBlows) report.zones += static_cast<int>(verification.failures().size());
    verification.find(scene, broad, narrow, candidates, team);
  }
  for (const Failure& failure : verification.failures()) {
    ++report.left;
    const PairList& pairs = candidates[failure.list];
    for (const std::uint32_t point : pairs.points(failure.pair)) {
      if (scene.points.is_of_cloth(point)) lost(point, pairs.pairs[failure.pair]);
    }
  }
}

}  // namespace weft
