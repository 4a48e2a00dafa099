#include "engine/contact/rescue.h"

#include <algorithm>

#include "engine/contact/look.h"
#include "engine/contact/mover.h"
#include "engine/contact/respond.h"

namespace weft::rescue {

using kernels::Vector;

namespace {

/// The velocity of a particle; one that the caller moves is as fast as in the interval.
Vector velocity_in(const ContactScene& scene, std::uint32_t slot, double time) {
  const ContactPoints& points = scene.points;
  if (points.inverse_mass(slot) > 0) return scene.particles.read(slot).v;
  return (1 / time) * (points.end(slot) - points.start(slot));
}

}  // namespace

void apply_impact(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                  double time) {
  ContactPoints& points = scene.points;
  const Pair& pair = pairs.pairs[failure.pair];
  const auto four = pairs.points(failure.pair);
  FourPoints there;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector from = points.start(four[k]);
    there[k] = from + failure.time * (points.end(four[k]) - from);
  }
  ContactSurface& later = points.later(pair);
  const Look met = look(later, pair, there);
  const Vector n = met.normal;
  const double l = length(nearest(pair.kind, points.starts_of(four)).r);
  const double thickness = points.thickness_of(pair);
  const double least = l > kTouching ? std::min(l, thickness) : thickness;
  double height = 0, weight = 0;
  Vector approach{}, surface{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = met.nearest.weight[k];
    height += w * dot(n, points.end(four[k]));
    weight += w * w * points.inverse_mass(four[k]);
    if (pair.is_within_cloth()) {
      approach = approach + w * velocity_in(scene, four[k], time);
    } else if (points.is_of_cloth(four[k])) {
      approach = approach + w * scene.particles.read(four[k]).v;
    } else {
      const Vector v = (w / time) * (points.end(four[k]) - points.start(four[k]));
      approach = approach + v;
      surface = surface - pair.outward() * v;
    }
  }
  if (!(weight > 0)) return;
  weight = std::max(weight, least_weight(points, four));
  const double push = std::max(0.0, least - height) / weight;
  const double stop = std::max(0.0, -dot(n, approach)) / weight;
  Mover mover(scene, later.body);
  for (std::size_t k = 0; k < 4; ++k) {
    const double part = met.nearest.weight[k] * points.inverse_mass(four[k]);
    if (part == 0) continue;
    mover.move(four[k], (part * push) * n, (part * stop) * n, surface);
  }
}

}  // namespace weft::rescue

namespace weft {

void stop_failures(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
                   Verification& verification, Candidates& candidates, double time,
                   ImpactZones& zones, RescueReport& report, Team& team) {
  using tuning::kImpactRounds, tuning::kZoneRounds, tuning::kClothZoneRounds;
  const int zone_rounds = scene.points.touches_itself() ? kClothZoneRounds : kZoneRounds;
  report.failures += static_cast<int>(verification.failures().size());
  zones.begin();
  for (int round = 0; round < kImpactRounds + zone_rounds; ++round) {
    const std::vector<Failure>& failures = verification.failures();
    if (failures.empty()) break;
    if (round == kImpactRounds) report.zones += static_cast<int>(failures.size());
    if (round < kImpactRounds) {
      for (const Failure& failure : failures)
        rescue::apply_impact(scene, candidates[failure.list], failure, time);
    } else {
      for (const Failure& failure : failures)
        zones.join(candidates[failure.list].points(failure.pair));
      if (round >= kImpactRounds + kZoneRounds) zones.grow(scene);
      zones.move(scene, time);
    }
    verification.find(scene, search, near_search, candidates, team);
  }
}

}  // namespace weft
