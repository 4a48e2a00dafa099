#include "engine/contact/rescue.h"

#include <algorithm>

#include "engine/contact/look.h"

namespace weft::rescue {

using kernels::Vector;

namespace {

/// Moves the particles of a pair, in the end of the interval, and tells the body.
class Mover {
 public:
  Mover(const ContactScene& scene, const ContactMesh& mesh) : scene_(scene), mesh_(mesh) {}

  void move(std::uint32_t slot, Vector by, Vector faster, Vector of_surface) {
    ContactParticle particle = scene_.particles.read(slot);
    particle.x = particle.x + by;
    particle.v = particle.v + faster;
    scene_.particles.write(slot, particle);
    const TouchedSurface surface{static_cast<std::uint32_t>(mesh_.body), of_surface};
    scene_.particles.stop(slot, surface);
    scene_.points.set_end(slot, particle.x);
    const double momentum = scene_.model.mass[slot] * scene_.particles.momentum_share();
    scene_.impulses.add(mesh_.body, scene_.clock.motions()[mesh_.body].to.centre, particle.x,
                        momentum * faster, of_surface);
  }

 private:
  const ContactScene& scene_;
  const ContactMesh& mesh_;
};

}  // namespace

void blow(const ContactScene& scene, const PairList& pairs, const Failure& failure, double time) {
  const ContactPoints& points = scene.points;
  const Pair& pair = pairs.pairs[failure.pair];
  const auto four = pairs.points(failure.pair);
  FourPoints there;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector from = points.start(four[k]);
    there[k] = from + failure.time * (points.end(four[k]) - from);
  }
  const reference::Nearest met = nearest(pair.kind, there);
  ContactMesh& mesh = scene.points.meshes()[pair.mesh];
  const Vector n = direction_apart(mesh, pair, met);
  FourPoints before;
  for (std::size_t k = 0; k < 4; ++k) before[k] = points.start(four[k]);
  const double l = length(nearest(pair.kind, before).r);
  const double least = l > kTouching ? std::min(l, mesh.thickness) : mesh.thickness;
  double height = 0, weight = 0;
  Vector approach{}, surface{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = met.weight[k];
    height += w * dot(n, points.end(four[k]));
    if (points.is_of_cloth(four[k])) {
      approach = approach + w * scene.particles.read(four[k]).v;
      weight += w * w * scene.model.inverse_mass[four[k]];
    } else {
      const Vector v = (w / time) * (points.end(four[k]) - points.start(four[k]));
      approach = approach + v;
      surface = surface - towards_cloth(pair.kind) * v;
    }
  }
  if (!(weight > 0)) return;
  weight = std::max(weight, least_weight(scene.model, four, points));
  const double push = std::max(0.0, least - height) / weight;
  const double stop = std::max(0.0, -dot(n, approach)) / weight;
  Mover mover(scene, mesh);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!points.is_of_cloth(four[k])) continue;
    const double part = met.weight[k] * scene.model.inverse_mass[four[k]];
    if (part == 0) continue;
    mover.move(four[k], (part * push) * n, (part * stop) * n, surface);
  }
}

void take_along(const ContactScene& scene, const PairList& pairs, const Failure& failure,
                double time) {
  const ContactPoints& points = scene.points;
  const Pair& pair = pairs.pairs[failure.pair];
  const auto four = pairs.points(failure.pair);
  FourPoints before;
  for (std::size_t k = 0; k < 4; ++k) before[k] = points.start(four[k]);
  const reference::Nearest met = nearest(pair.kind, before);
  Vector way{};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (points.is_of_cloth(four[k])) continue;
    way = way + met.weight[k] * (points.end(four[k]) - points.start(four[k]));
    sum += met.weight[k];
  }
  way = (1 / sum) * way;
  const Vector v = (1 / time) * way;
  Mover mover(scene, points.meshes()[pair.mesh]);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!points.is_of_cloth(four[k]) || scene.model.inverse_mass[four[k]] == 0) continue;
    const ContactParticle particle = scene.particles.read(four[k]);
    mover.move(four[k], points.start(four[k]) + way - particle.x, v - particle.v, v);
  }
}

}  // namespace weft::rescue

namespace weft {

void stop_failures(const ContactScene& scene, const CandidateSearch& broad, NearSearch& narrow,
                   Verification& verification, Candidates& candidates, double time,
                   RescueReport& report, Team& team) {
  constexpr int kBlows = 8, kZones = 12;  // rounds
  report.failures += static_cast<int>(verification.failures().size());
  for (int round = 0; round < kBlows + kZones && !verification.failures().empty(); ++round) {
    for (const Failure& failure : verification.failures()) {
      if (round < kBlows)
        rescue::blow(scene, candidates[failure.list], failure, time);
      else
        rescue::take_along(scene, candidates[failure.list], failure, time);
    }
    if (round >= kBlows) report.zones += static_cast<int>(verification.failures().size());
    verification.find(scene, broad, narrow, candidates, team);
  }
}

}  // namespace weft
