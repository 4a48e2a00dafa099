#include "engine/contact/respond.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

double volume(PairKind kind, const FourPoints& x) {
  if (kind == PairKind::edges) return dot(cross(x[1] - x[0], x[3] - x[2]), x[2] - x[0]);
  return dot(cross(x[2] - x[1], x[3] - x[1]), x[0] - x[1]);
}

/// The share of a substep at which the four points of a pair lie in one plane: where the volume
/// that they span, which has different signs at both ends, is 0. (Regula falsi, Illinois.)
double time_in_plane(PairKind kind, const auto& pair, double before, double after) {
  double from = 0, to = 1, at_from = before, at_to = after, share = 0;
  for (int i = 0; i < tuning::kPlaneSteps; ++i) {
    share = from + (to - from) * at_from / (at_from - at_to);
    const double here = volume(kind, pair.at_share(share));
    if (here == 0) return share;
    if ((here > 0) == (at_to > 0)) {
      to = share;
      at_to = here;
      at_from *= 0.5;
    } else {
      from = share;
      at_from = here;
      at_to *= 0.5;
    }
  }
  return share;
}

/// Whether the features went through each other in this substep: where their points lie in a plane
/// they are at one place.
bool has_crossed(PairKind kind, const auto& pair, double thickness) {
  const double before = volume(kind, pair.start), after = volume(kind, pair.x);
  if ((before > 0) == (after > 0)) return false;
  const double share = time_in_plane(kind, pair, before, after);
  return length(nearest(kind, pair.at_share(share)).r) < tuning::kTogether * thickness + kTouching;
}

/// Whether one feature is on the wrong side of the other. r: between them as they are; side: the
/// normal as last seen. A feature beyond it went through in this substep, or was under when it
/// began; else it went around an edge.
bool is_now_under(PairKind kind, const auto& pair, Vector r, Vector side, bool was_under,
                  double thickness) {
  if (dot(r, side) > 0) return false;
  const Vector before = nearest(kind, pair.start).r;
  if (was_under && dot(before, side) <= 0) return true;
  if (length(before) <= kTouching) return dot(r, side) < -kTouching;  // else it slid along
  return has_crossed(kind, pair, thickness);
}

}  // namespace

double least_weight(const ContactPoints& points, const std::array<std::uint32_t, 4>& four) {
  return tuning::kLeastTouchWeight * points.largest_inverse_mass(four);
}

void Response::begin(const ContactScene& scene, const Near& near) {
  for (const std::uint32_t point : asked_) is_asked_[point] = false;
  asked_.clear();
  for (std::size_t list = 0; list < kBodyLists; ++list) {
    for (auto* bits : {&touching_[list], &touching_now_[list]})
      bits->assign(near[list].list.blocks.size(), 0);
    for (std::size_t i = 0; i < near[list].list.size(); ++i) {
      for (const std::uint32_t point : near[list].list.points(i)) {
        if (point >= is_asked_.size()) is_asked_.resize(point + 1);
        if (is_asked_[point]) continue;
        is_asked_[point] = true;
        asked_.push_back(point);
      }
    }
  }
  scene.present.begin_interval(asked_);
  first_link_.resize(scene.model.slots(), kNoIndex);
}

void Response::advance(const ContactScene& scene, Near& near) {
  scene.present.place_vertices(scene.clock);
  for (NearPairs& pairs : near) {
    for (NearState& state : pairs.states) {
      state.is_touching = state.is_linked = false;
      state.push = 0;
      state.sums = {};
    }
  }
  for (const std::uint32_t slot : linked_) first_link_[slot] = kNoIndex;
  linked_.clear();
  links_.clear();
}

simd::PairTouch Response::touch_of(const ContactScene& scene, NearPairs& near,
                                   std::vector<std::uint16_t>& touching) const {
  return {.pairs = near.list.blocks.data(),
          .points = scene.present.places(),
          .rounding = kRoundings * scene.points.rounding(),
          .sides = near.sides.data(),
          .touching = touching.data()};
}

void Response::find_touching(const ContactScene& scene, Near& near, Team& team) {
  scene.present.read_cloth(scene.particles);
  for (std::size_t list = 0; list < kBodyLists; ++list) {
    NearPairs& pairs = near[list];
    const simd::PairTouch touch = touch_of(scene, pairs, touching_[list]);
    team.for_each_share(pairs.list.blocks.size(), [&](std::size_t first, std::size_t last) {
      table_.touch_pairs(touch, has_edges(list), first, last);
    });
  }
}

namespace {

/// 1/kg: the sum of W w^2, or the least that counts; 0 where nothing moves.
double weight_of(const ContactScene& scene, const PairContact& e) {
  double weight = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = e.nearest.weight[k];
    weight += scene.points.inverse_mass(e.points[k]) * w * w;
  }
  return weight > 0 ? std::max(weight, least_weight(scene.points, e.points)) : 0;
}

/// The motion of a body's surface beside that of its feature, which is in the middle of what is
/// round: by its turn in the substep (m), and its spin (m/s).
Vector turn_of_arm(const ContactScene& scene, const PairContact& e, const Pair& pair) {
  const reference::BodyMotion& body = scene.clock.motions()[scene.points.later(pair).body];
  return e.arm - body.from.turned(body.to.turned_back(e.arm));
}
Vector speed_of_arm(const ContactScene& scene, const PairContact& e, const Pair& pair) {
  return cross(scene.clock.motions()[scene.points.later(pair).body].spin, e.arm);
}

/// The velocity of the first feature beside the second.
Vector relative_velocity(const ContactScene& scene, const PairContact& e, const Pair& pair) {
  Vector relative = -pair.outward() * speed_of_arm(scene, e, pair);
  for (std::size_t k = 0; k < 4; ++k)
    relative = relative + e.nearest.weight[k] * scene.present[e.points[k]].v;
  return relative;
}

/// As it was last read.
void read_start(const PresentPoints& present, PairContact& e) {
  for (std::size_t k = 0; k < 4; ++k) e.start[k] = present[e.points[k]].start;
}

}  // namespace

/// Where neighbours are nearer, or the features are not beside each other, it does not push.
PairContact Response::contact_of(const ContactScene& scene, const NearPairs& near, std::size_t i) {
  const Pair& pair = near.list.pairs[i];
  PairContact e;
  e.points = near.list.points(i);
  for (std::size_t k = 0; k < 4; ++k) e.x[k] = scene.present[e.points[k]].x;
  e.nearest = nearest(pair.kind, e.x);
  const ContactSurface& later = scene.points.later(pair);
  const double radius = later.radius_at(e.points, e.nearest.weight);
  const double thickness = near.states[i].thickness - (later.largest_radius() - radius);
  const Vector side = near.normal(i);
  const double l = length(e.nearest.r);
  const Vector direct = l > kTouching ? (1 / l) * e.nearest.r : side;
  if (!(dot(e.nearest.r, side) > 0)) {
    read_start(scene.present, e);
    e.is_under = is_now_under(pair.kind, e, e.nearest.r, side, near.is_under(i), thickness);
  }
  e.normal = e.is_under ? -1.0 * direct : direct;
  e.gap = (e.is_under ? -l : l) - thickness;
  e.arm = (pair.outward() * radius) * e.normal;
  e.thinning = scene.thinning(e.points, e.nearest.weight, later.body);
  if (!(e.gap + e.thinning.by < 0) || !is_in_place(pair.kind, e.nearest)) return e;
  const Vector seen = pair.kind == PairKind::edges ? e.normal : direct;
  e.pushes = !is_ghost(scene.points.surfaces(), pair, e.x, e.nearest, seen, tuning::kTouchLean,
                       [&](std::uint32_t point) { return scene.now(point); });
  return e;
}

bool Response::solve(const ContactScene& scene, NearPairs& near, std::size_t i) {
  const Pair& pair = near.list.pairs[i];
  NearState& state = near.states[i];
  PairContact e = contact_of(scene, near, i);
  near.set_under(i, e.is_under);
  near.set_normal(i, e.normal);
  if (!e.pushes) return false;
  read_start(scene.present, e);
  if (!(weight_of(scene, e) > 0)) return false;
  Vector slip = -pair.outward() * turn_of_arm(scene, e, pair);
  for (std::size_t k = 0; k < 4; ++k) slip = slip + e.nearest.weight[k] * (e.x[k] - e.start[k]);
  state.sums.thinning = e.thinning;
  const ContactSurface& later = scene.points.later(pair);
  const reference::Stop stop = reference::stop({e.normal, e.gap, slip}, later.friction,
                                               scene.clock.dt_substep(), state.sums);
  if (!(stop.push > 0)) return false;
  state.is_touching = true;
  state.push += stop.push;
  apply(scene, e, pair, stop,
        reference::slow(e.normal, relative_velocity(scene, e, pair), later.friction,
                        scene.clock.dt_substep(), state.sums));
  return true;
}

/// Pairs that have touched in this substep, and are now farther apart than their pushes intended,
/// come back. Otherwise other corrections would lift their points off a surface that supports them.
void Response::take_back_excess(const ContactScene& scene, Near& near) const {
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const auto [list, i, next] = links_[k];
    if (k > 0 && links_[k - 1].list == list && links_[k - 1].pair == i)
      continue;  // by another point
    reference::ContactSums& sums = near[list].states[i].sums;
    if (!(sums.pushed > 0)) continue;
    scene.present.read(near[list].list.points(i), scene.particles);
    const PairContact e = contact_of(scene, near[list], i);
    const double back = std::min(e.gap + e.thinning.by, sums.pushed), weight = weight_of(scene, e);
    if (!(back > 0) || !(weight > 0)) continue;
    const double apart = dot(relative_velocity(scene, e, near[list].list.pairs[i]), e.normal),
                 slower = std::clamp(apart, 0.0, sums.stopped);
    sums.pushed -= back;
    sums.stopped -= slower;
    near[list].states[i].push -= back;
    apply(scene, e, near[list].list.pairs[i], {.push = -back, .by = -back * e.normal},
          {.change = -slower * e.normal});
  }
}

std::pair<TouchedSurface, Vector> Response::touched_by(const ContactPoints& points,
                                                       const PresentPoints& present,
                                                       const Near& near, std::uint32_t slot) const {
  std::pair<TouchedSurface, Vector> touched;
  double most = 0;
  for (std::uint32_t link = slot < first_link_.size() ? first_link_[slot] : kNoIndex;
       link != kNoIndex; link = links_[link].next) {
    const NearPairs& pairs = near[links_[link].list];
    const std::size_t i = links_[link].pair;
    if (!(pairs.states[i].push > most)) continue;
    most = pairs.states[i].push;
    const Pair& pair = pairs.list.pairs[i];
    touched.second = pair.outward() * pairs.normal(i);
    touched.first = {.body = points.later(pair).body};
    for (const std::uint32_t point : pairs.list.points(i)) {
      if (!points.is_of_cloth(point)) touched.first.velocity = present[point].v;
    }
  }
  return touched;
}

/// Moves what can move, and loads the body.
void Response::apply(const ContactScene& scene, const PairContact& e, const Pair& pair,
                     const reference::Stop& stop, const reference::Slowed& slow) {
  const ContactSurface& later = scene.points.later(pair);
  const double weight = weight_of(scene, e);
  TouchedSurface surface{.body = later.body, .velocity = speed_of_arm(scene, e, pair)};
  Vector on_body = e.arm;
  for (std::size_t k = 0; k < 4; ++k) {
    if (scene.points.is_of_cloth(e.points[k])) continue;
    const double outward = pair.outward() * e.nearest.weight[k];
    surface.velocity = surface.velocity - outward * scene.present[e.points[k]].v;
    on_body = on_body - outward * e.x[k];
  }
  Vector impulse{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double share = scene.points.inverse_mass(e.points[k]) * e.nearest.weight[k];
    if (share == 0) continue;
    const double part = share / weight;
    ContactParticle p = scene.present[e.points[k]];
    p.start = p.start + (part * stop.comes_out) * e.normal;
    p.x = p.x + part * stop.by;
    p.v = p.v + part * slow.change;
    scene.particles.write(e.points[k], p);
    scene.present.set(e.points[k], scene.particles.read(e.points[k]));
    scene.particles.touch(e.points[k], surface);
    const double momentum = scene.model.mass[e.points[k]] * scene.particles.momentum_share();
    impulse = impulse + (momentum * part) * slow.change;
  }
  scene.impulses.add(later.body, scene.clock.motions()[later.body].to.centre, on_body, impulse,
                     surface.velocity);
  const double l_change = length(slow.change);
  if (l_change > 0) {
    scene.impulses.friction +=
        length(impulse) / l_change * slow.taken * (stop.slid / scene.clock.dt_substep());
  }
}

void Response::remember(const ContactScene& scene, NearPairs& near, std::size_t list,
                        std::size_t i) {
  if (std::exchange(near.states[i].is_linked, true)) return;
  for (const std::uint32_t point : near.list.points(i)) {
    if (!scene.points.is_of_cloth(point)) continue;
    if (first_link_[point] == kNoIndex) linked_.push_back(point);
    links_.push_back(
        {static_cast<std::uint32_t>(list), static_cast<std::uint32_t>(i), first_link_[point]});
    first_link_[point] = static_cast<std::uint32_t>(links_.size() - 1);
  }
}

bool Response::solve_at(const ContactScene& scene, Near& near, std::uint32_t slot) {
  bool is_pushed = false;
  for (std::uint32_t link = slot < first_link_.size() ? first_link_[slot] : kNoIndex;
       link != kNoIndex; link = links_[link].next) {
    visits_ += tuning::kVisitsOfTouch;
    scene.present.read(near[links_[link].list].list.points(links_[link].pair), scene.particles);
    is_pushed = solve(scene, near[links_[link].list], links_[link].pair) || is_pushed;
  }
  return is_pushed;
}

double Response::deepest(const ContactScene& scene, Near& near, Team& team) {
  find_touching(scene, near, team);
  double deepest = 0;
  for (std::size_t list = 0; list < kBodyLists; ++list) {
    for (std::size_t block = 0; block < touching_[list].size(); ++block) {
      for_each_lane(block, touching_[list][block], [&](std::size_t i) {
        const PairContact e = contact_of(scene, near[list], i);
        const double spared = std::min(
            e.thinning.by, near[list].states[i].thickness -
                               scene.points.later(near[list].list.pairs[i]).largest_radius());
        if (e.pushes) deepest = std::max(deepest, -e.gap - spared);
      });
    }
  }
  return deepest;
}

std::size_t Response::bytes() const {
  return bytes_of(touching_[0]) + bytes_of(touching_[1]) + bytes_of(touching_now_[0]) +
         bytes_of(touching_now_[1]) + bytes_of(asked_) + is_asked_.capacity() / 8 +
         bytes_of(first_link_) + bytes_of(linked_) + bytes_of(links_);
}

}  // namespace weft
