#include "engine/contact/interval.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

/// s, in which that way (m) is taken, and no longer than that.
double time_for(double way, double speed, double longest) {
  return speed * longest > way ? way / speed : longest;
}

}  // namespace

void SurfaceContacts::begin(const BodyClock& clock, ContactStart start, const Misplaced& misplaced,
                            const ContactMemory* memory) {
  if (start != ContactStart::goes_on) points_.begin(clock);
  interval_ = late_depth_ = 0;
  has_looked_ahead_ = false;
  failures_ = {};
  contacts_.begin(memory);
  untangling_.begin();
  for (NearPairs& near : near_) near.clear();
  if (empty()) return;
  impulses_.begin(clock.bodies());
  start_ = start;
  if (start != ContactStart::goes_on) tangles_.begin(points_.cloth(), misplaced);
  began_tangled_ = tangles_.count_within() > 0;
}

double SurfaceContacts::interval_for(const ContactParticles& particles, const BodyClock& clock) {
  if (empty()) return tuning::kContactInterval;
  if (!std::exchange(has_looked_ahead_, true)) points_.look_ahead(particles, clock);
  const ContactSpeeds& speeds = points_.speeds();
  const double thickness = points_.largest_thickness(), way = tuning::kMeshWay * thickness;
  double time = tuning::kContactInterval;
  if (clock.bodies().size() <= 1 && tangles_.count_within() == 0) {
    const double calm =
        std::sqrt(2 * tuning::kContactSpare * thickness / tuning::kCalmAcceleration);
    const double together = speeds.of_cloth + speeds.of_near;
    time = std::max(time, time_for(tuning::kCalmWay * thickness, together, calm));
  }
  return time_for(way, speeds.of_near, time);
}

void SurfaceContacts::predict(ContactParticles& particles, const BodyClock& clock, Team& team) {
  if (empty() || still_holds(particles, clock)) return;
  if (clock.stands()) {
    end_interval(particles, clock, team);
    begin_interval(particles, clock, 1, team);
  } else if (clock.begins_interval()) {
    begin_interval(particles, clock, clock.substeps_of_interval(), team);
  }
}

/// While positions are projected, by any way, until a particle comes to a place that was not
/// expected.
bool SurfaceContacts::still_holds(const ContactParticles& particles, const BodyClock& clock) const {
  return clock.stands() && interval_ > 0 && points_.hold(particles);
}

void SurfaceContacts::begin_interval(ContactParticles& particles, const BodyClock& clock,
                                     int substeps, Team& team) {
  points_.begin_interval(particles, clock, substeps);
  tangles_.begin_interval();
  const bool have_moved = search_.find(points_, candidates_, team);
  const ContactStart start = std::exchange(start_, ContactStart::known);
  if (start != ContactStart::known) {
    tangles_.find(points_);
    if (start == ContactStart::anew) tangles_.find_within(points_);
    began_tangled_ = tangles_.count_within() > 0;
  }
  untangling_.leave();
  if (model_.self_contact.untangle && !clock.stands())
    untangling_.begin_interval(points_, tangles_.crossing_within());
  near_search_.measure(points_, candidates_, have_moved, team);
  near_search_.find(points_, candidates_, tangles_, near_, team);
  layers_.anew = have_moved || contacts_.empty() || tangles_.count_within() > 0;
  near_search_.find_layers(points_, candidates_, tangles_, layers_);
  contacts_.find(points_, layers_);
  tangles_.come_out(points_, near_);
  response_.begin(scene(particles, clock), near_);
  narrow_gaps_.begin(scene(particles, clock), near_);
  for (const PairList& list : candidates_)
    visits_ += tuning::kVisitsOfLook * static_cast<double>(list.size());
  for (const NearPairs& near : near_)
    visits_ += tuning::kVisitsOfTouch * static_cast<double>(near.list.size());
  interval_ = substeps * clock.dt_substep();
}

void SurfaceContacts::advance(ContactParticles& particles, const BodyClock& clock, Team& team) {
  if (empty()) return;
  const ContactScene scene = this->scene(particles, clock);
  response_.advance(scene, near_);
  narrow_gaps_.share(scene, near_);
  untangling_.pull(scene);
  contacts_.begin_substep(points_, particles, clock.dt_substep(), clock.stands(), team);
}

bool SurfaceContacts::end_interval(ContactParticles& particles, const BodyClock& clock,
                                   Team& team) {
  if (empty() || interval_ == 0) return false;
  if (clock.stands()) return verify_standing(particles, clock, team);
  if (!clock.is_interval_over()) return false;
  const ContactScene scene = this->scene(particles, clock);
  points_.measure_moves(particles);
  late_depth_ = 0;
  narrow_gaps_.take_in(scene, near_, tangles_);
  bool has_moved = push_late_apart(scene, team);
  verification_.find(scene, search_, near_search_, candidates_, team);
  const bool has_failed = !verification_.failures().empty();
  has_moved = has_moved || has_failed;
  if (has_moved) {
    expect_failures(scene);
    stop_failures(scene, team);
  }
  find_tangles(has_failed);
  if (!has_moved) return false;
  verification_.find_late(scene, near_search_, candidates_, team);
  for (const Failure& late : verification_.failures())
    late_depth_ = std::max(late_depth_, late.depth);
  return true;
}

/// Cloth that is projected does not go through itself. Crossings of bodies are stopped when it
/// moves: they tell on which side it belongs.
bool SurfaceContacts::verify_standing(ContactParticles& particles, const BodyClock& clock,
                                      Team& team) {
  if (!points_.touches_itself()) return false;
  const ContactScene scene = this->scene(particles, clock);
  points_.measure_moves(particles);
  verification_.find(scene, search_, near_search_, candidates_, team);
  const bool has_failed = !verification_.failures().empty();
  if (has_failed) stop_failures(scene, team);
  find_tangles(has_failed);
  return has_failed;
}

void SurfaceContacts::stop_failures(const ContactScene& scene, Team& team) {
  weft::stop_failures(scene, search_, near_search_, verification_, candidates_, interval_, zones_,
                      failures_, team);
  for (const Failure& failure : verification_.failures())
    tangles_.take_in(points_, candidates_[failure.list].pairs[failure.pair]);
}

/// When an interval ends. Only tangles, and what had to be stopped, lead others through a body.
void SurfaceContacts::find_tangles(bool has_failed) {
  if (tangles_.any() || has_failed) tangles_.find_crossing_at_end(points_);
  if (points_.touches_itself()) tangles_.find_crossing_within_at_end(points_, has_failed);
}

/// Before the rest is verified. Returns whether particles had to be moved.
bool SurfaceContacts::push_late_apart(const ContactScene& scene, Team& team) {
  for (int round = 0; round < tuning::kLateRounds; ++round) {
    verification_.find_late(scene, near_search_, candidates_, team);
    if (verification_.failures().empty()) return round > 0;
    expect_failures(scene);
    for (const Failure& late : verification_.failures())
      rescue::apply_impact(scene, candidates_[late.list], late, interval_);
  }
  return true;
}

/// Pairs that were not expected to touch are near from now on, so that putting the cloth right
/// until the step is over keeps them apart. Pairs that went through unnoticed were taken to be on
/// the other side: now their side is known.
void SurfaceContacts::expect_failures(const ContactScene& scene) {
  bool any = false;
  for (const Failure& failure : verification_.failures()) {
    const Pair& pair = candidates_[failure.list].pairs[failure.pair];
    if (pair.is_within_cloth()) continue;
    NearPairs& near = near_[failure.list];
    const std::size_t known = near.find(pair);
    const bool is_known = known < near.list.size();
    const bool is_late = failure.depth > 0;
    if (is_known && is_late) continue;
    const auto four = candidates_[failure.list].points(failure.pair);
    ContactSurface& later = points_.later(pair);
    const Vector normal = look(later, pair, points_.starts_of(four)).normal;
    if (is_known) {
      near.set_normal(known, normal);
      near.set_under(known, false);
    } else {
      near.add(pair, four, normal, points_.thickness_of(pair), false);
      any = true;
    }
  }
  if (!any) return;
  response_.begin(scene, near_);
  scene.present.place_vertices(scene.clock);
}

SurfaceContacts::Touching SurfaceContacts::count_touching() const {
  Touching count;
  for (const NearPairs& near : near_) {
    for (std::size_t i = 0; i < near.list.size(); ++i) {
      if (near.states[i].is_touching) ++count.bodies;
    }
  }
  count.within_cloth = contacts_.count_touching();
  return count;
}

void SurfaceContacts::read_touching(const ContactParticles& particles, const BodyClock& clock,
                                    std::vector<BodyTouch>& touches) const {
  const auto at = [&](std::uint32_t point) {
    return points_.is_of_cloth(point) ? particles.position(point) : present_[point].x;
  };
  for (const NearPairs& near : near_) {
    for (std::size_t i = 0; i < near.list.size(); ++i) {
      const Pair& pair = near.list.pairs[i];
      if (!near.states[i].is_touching) continue;
      const auto four = near.list.points(i);
      const reference::Nearest found =
          nearest(pair.kind, {at(four[0]), at(four[1]), at(four[2]), at(four[3])});
      const ContactSurface& later = points_.later(pair);
      BodyTouch touch{.body = clock.bodies()[later.body].id, .push = near.states[i].push};
      touch.normal = pair.outward() * near.normal(i);
      touch.point = later.radius_at(four, found.weight) * touch.normal;
      double most = -1;
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = std::abs(found.weight[k]);
        if (!points_.is_of_cloth(four[k])) {
          touch.point = touch.point + weight * at(four[k]);
        } else if (weight > most) {
          most = weight;
          touch.slot = four[k];
        }
      }
      touches.push_back(touch);
    }
  }
}

std::size_t SurfaceContacts::bytes() const {
  std::size_t bytes = points_.bytes() + present_.bytes() + search_.bytes() + near_search_.bytes() +
                      response_.bytes() + narrow_gaps_.bytes() + tangles_.bytes() +
                      untangling_.bytes() + bytes_of(impulses_.of_body) + zones_.bytes();
  for (const PairList& list : candidates_) bytes += list.bytes();
  for (const NearPairs& near : near_)
    bytes +=
        near.list.bytes() + bytes_of(near.sides) + bytes_of(near.states) + bytes_of(near.turned);
  return bytes;
}

}  // namespace weft
