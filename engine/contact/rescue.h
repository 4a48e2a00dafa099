/// Stage 8 of an interval stops pairs that went through each other. First inelastic impacts stop
/// them where they would have met. These may send other pairs through each other, so there are
/// rounds. Then pairs that still fail move in rigid zones, which grow by the particles that they
/// meet (impact_zones.h).
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
void apply_impact(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                  double time);

}  // namespace rescue

}  // namespace weft
