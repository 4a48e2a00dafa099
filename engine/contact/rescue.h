/// Stage 8 of an interval: what to do about pairs that went through each other. First they
/// are stopped where they would have met, as by inelastic blows; that may send others through each
/// other, so it is done in rounds. Then what still fails moves in rigid zones, which grow by what
/// they meet (impact_zones.h).
#pragma once

#include "engine/contact/impact_zones.h"
#include "engine/contact/rescue_report.h"
#include "engine/contact/verify.h"

namespace weft {

/// Until all is verified, or its rounds are over: then failures are left.
void stop_failures(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
                   Verification& verification, Candidates& candidates, double time,
                   ImpactZones& zones, RescueReport& report, Team& team);

namespace rescue {

/// time: s, of the interval.
void blow(const ContactScene& scene, const PairList& pairs, const Failure& failure, double time);

}  // namespace rescue

}  // namespace weft
