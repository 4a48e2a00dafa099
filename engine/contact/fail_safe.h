/// Stage 8 of contacts with meshes: what to do about pairs that went through each other. First they
/// are stopped where they would have met, as by inelastic blows; that may send others through each
/// other, so it is done in rounds. Then what still fails is taken along by the body as if it stuck
/// to it: a rigid impact zone (Bridson, Fedkiw and Anderson, 2002) whose motion is the body's.
#pragma once

#include "engine/contact/fail_safe_report.h"
#include "engine/contact/verification.h"

namespace weft {

/// Until all is verified, or its rounds are over: then failures are left.
void stop_failures(const ContactScene& scene, const BroadPhase& broad, NarrowPhase& narrow,
                   Verification& verification, Candidates& candidates, double time,
                   FailSafeReport& report, Team& team);

namespace fail_safe {

/// time: s, of the interval.
void blow(const ContactScene& scene, const PairList& pairs, const Failure& failure, double time);
void take_along(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                double time);

}  // namespace fail_safe

}  // namespace weft
