#include "engine/contact/rescue.h"

#include <algorithm>

#include "engine/contact/look.h"
#include "engine/contact/respond.h"

namespace weft::rescue {

using kernels::Vector;

namespace {

/// Moves particles in the end of the interval, and loads the body that they were stopped by.
class Mover {
 public:
  /// body: kNoIndex where cloth stops cloth.
  Mover(const ContactScene& scene, std::uint32_t body) : scene_(scene), body_(body) {}

  void move(std::uint32_t slot, Vector by, Vector faster, Vector of_surface) {
    ContactParticle particle = scene_.particles.read(slot);
    const Vector before = particle.v;
    particle.x = particle.x + by;
    particle.v = particle.v + faster;
    scene_.particles.write(slot, particle);
    if (body_ == kNoIndex) return hold(slot, before);
    scene_.points.set_end(slot, particle.x);
    scene_.particles.stop(slot, {body_, of_surface});
    const double momentum = scene_.model.mass[slot] * scene_.particles.momentum_share();
    scene_.impulses.add(body_, scene_.clock.motions()[body_].to.centre, particle.x,
                        momentum * faster, of_surface);
  }

 private:
  /// What cloth has moved is held by bodies of a closed form: what it meets takes the rest.
  void hold(std::uint32_t slot, Vector v_before) {
    scene_.particles.push(slot, {}, {});
    scene_.points.set_end(slot, scene_.particles.position(slot));
    scene_.particles.jolt(slot, scene_.particles.read(slot).v - v_before);
  }

  const ContactScene& scene_;
  const std::uint32_t body_;
};

/// Of a particle; one that the caller moves is as fast as in the interval.
Vector velocity_in(const ContactScene& scene, std::uint32_t slot, double time) {
  const ContactPoints& points = scene.points;
  if (points.inverse_mass(slot) > 0) return scene.particles.read(slot).v;
  return (1 / time) * (points.end(slot) - points.start(slot));
}

}  // namespace

void blow(const ContactScene& scene, const PairList& pairs, const Failure& failure, double time) {
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

void take_along(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                double time) {
  const ContactPoints& points = scene.points;
  const Pair& pair = pairs.pairs[failure.pair];
  const auto four = pairs.points(failure.pair);
  const reference::Nearest met = nearest(pair.kind, points.starts_of(four));
  Vector way{};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (points.is_of_cloth(four[k])) continue;
    way = way + met.weight[k] * (points.end(four[k]) - points.start(four[k]));
    sum += met.weight[k];
  }
  way = (1 / sum) * way;
  const Vector v = (1 / time) * way;
  Mover mover(scene, points.later(pair).body);
  for (std::size_t k = 0; k < 4; ++k) {
    if (points.inverse_mass(four[k]) == 0) continue;
    const ContactParticle particle = scene.particles.read(four[k]);
    mover.move(four[k], points.start(four[k]) + way - particle.x, v - particle.v, v);
  }
}

}  // namespace weft::rescue

namespace weft {

namespace {

/// Cloth that touches itself: a zone grows with each round by what it meets, until nothing does.
void stop_cloth(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
                Verification& verification, Candidates& candidates, double time, ImpactZones& zones,
                RescueReport& report, Team& team) {
  zones.begin();
  for (int round = 0; round < tuning::kBlowRounds + tuning::kClothZoneRounds; ++round) {
    if (verification.failures().empty()) break;
    if (round < tuning::kBlowRounds) {
      for (const Failure& failure : verification.failures())
        rescue::blow(scene, candidates[failure.list], failure, time);
    } else {
      for (const Failure& failure : verification.failures())
        zones.join(candidates[failure.list].points(failure.pair));
      if (round >= tuning::kBlowRounds + tuning::kZoneRounds) zones.grow(scene);
      zones.move(scene, time);
    }
    if (round == tuning::kBlowRounds)
      report.zones += static_cast<int>(verification.failures().size());
    verification.find(scene, search, near_search, candidates, team);
  }
}

}  // namespace

void stop_failures(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
                   Verification& verification, Candidates& candidates, double time,
                   ImpactZones& zones, RescueReport& report, Team& team) {
  using tuning::kBlowRounds, tuning::kZoneRounds;
  report.failures += static_cast<int>(verification.failures().size());
  if (scene.points.touches_itself()) {
    stop_cloth(scene, search, near_search, verification, candidates, time, zones, report, team);
    return;
  }
  for (int round = 0; round < kBlowRounds + kZoneRounds && !verification.failures().empty();
       ++round) {
    for (const Failure& failure : verification.failures()) {
      if (round < kBlowRounds)
        rescue::blow(scene, candidates[failure.list], failure, time);
      else
        rescue::take_along(scene, candidates[failure.list], failure, time);
    }
    if (round >= kBlowRounds) report.zones += static_cast<int>(verification.failures().size());
    verification.find(scene, search, near_search, candidates, team);
  }
}

}  // namespace weft
