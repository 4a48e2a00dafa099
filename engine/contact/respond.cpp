#include "engine/contact/respond.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

/// A pair in the present substep: its points where the substep began and where they are.
struct Encountered {
  std::array<std::uint32_t, 4> points{};
  std::array<ContactParticle, 4> at{};  // of the body: without a velocity of their own
  FourPoints start{}, x{};

  FourPoints at_share(double share) const {
    FourPoints there;
    for (std::size_t k = 0; k < 4; ++k) there[k] = start[k] + share * (x[k] - start[k]);
    return there;
  }
};

Encountered look_at(const ContactScene& scene, const std::array<std::uint32_t, 4>& points,
                    double h) {
  Encountered pair{.points = points};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t point = points[k];
    if (scene.points.is_of_cloth(point)) {
      pair.at[k] = scene.particles.read(point);
    } else {
      const Vector from = scene.points.from(point), to = scene.points.to(point);
      pair.at[k] = {from, to, (1 / h) * (to - from)};
    }
    pair.start[k] = pair.at[k].start;
    pair.x[k] = pair.at[k].x;
  }
  return pair;
}

/// The sine by which a neighbour may stand out of a pair that pushes.
constexpr double kLean = 0.02;

double volume(PairKind kind, const FourPoints& x) {
  if (kind == PairKind::edges) return dot(cross(x[1] - x[0], x[3] - x[2]), x[2] - x[0]);
  return dot(cross(x[2] - x[1], x[3] - x[1]), x[0] - x[1]);
}

/// The share of a substep at which the four points of a pair lie in one plane: where the volume
/// that they span, which has different signs at both ends, is 0. (Regula falsi, Illinois.)
double time_in_plane(PairKind kind, const Encountered& pair, double before, double after) {
  double from = 0, to = 1, at_from = before, at_to = after, share = 0;
  for (int i = 0; i < 16; ++i) {
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
bool has_crossed(PairKind kind, const Encountered& pair, double thickness) {
  const double before = volume(kind, pair.start), after = volume(kind, pair.x);
  if ((before > 0) == (after > 0)) return false;
  const double share = time_in_plane(kind, pair, before, after);
  constexpr double kTogether = 0.01;  // of the thickness
  return length(nearest(kind, pair.at_share(share)).r) < kTogether * thickness + 1e-9;
}

/// Whether the cloth is on the wrong side. r: between the features as they are; side: the normal as
/// last seen. Who is beyond it went through in this substep, or was under when it began; else the
/// cloth went around an edge of the body.
bool is_now_under(PairKind kind, const Encountered& pair, Vector r, Vector side, bool was_under,
                  double thickness) {
  if (dot(r, side) > 0) return false;
  const Vector before = nearest(kind, pair.start).r;
  if (was_under && dot(before, side) <= 0) return true;
  if (length(before) <= kTouching) return dot(r, side) < -kTouching;  // else it slid along
  return has_crossed(kind, pair, thickness);
}

}  // namespace

double least_weight(const Model& model, const std::array<std::uint32_t, 4>& points,
                    const ContactPoints& of) {
  constexpr double kLeast = 0.05;
  double lightest = 0;
  for (const std::uint32_t point : points) {
    if (of.is_of_cloth(point)) lightest = std::max(lightest, model.inverse_mass[point]);
  }
  return kLeast * lightest;
}

void Response::begin(const ContactScene& scene, const Near& near) {
  for (const std::uint32_t point : asked_) is_asked_[point] = false;
  asked_.clear();
  for (std::size_t list = 0; list < kPairLists; ++list) {
    touching_[list].assign(near[list].list.blocks.size(), 0);
    for (std::size_t i = 0; i < near[list].list.size(); ++i) {
      for (const std::uint32_t point : near[list].list.points(i)) {
        if (point >= is_asked_.size()) is_asked_.resize(point + 1);
        if (is_asked_[point]) continue;
        is_asked_[point] = true;
        asked_.push_back(point);
      }
    }
  }
  scene.points.ask_for(asked_);
  first_link_.resize(scene.model.slots(), kNoIndex);
}

void Response::advance(const BodyClock& clock, ContactPoints& points, Near& near) {
  points.place_vertices_asked(clock);
  for (NearPairs& pairs : near) {
    for (NearState& state : pairs.states) {
      state.is_touching = false;
      state.push = 0;
      state.grip = {};
    }
  }
  for (const std::uint32_t slot : linked_) first_link_[slot] = kNoIndex;
  linked_.clear();
  links_.clear();
}

void Response::find_touching(const ContactScene& scene, Near& near, Team& team) {
  scene.points.read_cloth(scene.particles);
  for (std::size_t list = 0; list < kPairLists; ++list) {
    NearPairs& pairs = near[list];
    const simd::PairTouch touch{.pairs = pairs.list.blocks.data(),
                                .points = scene.points.places(),
                                .sides = pairs.sides.data(),
                                .touching = touching_[list].data()};
    team.for_each_share(pairs.list.blocks.size(), [&](std::size_t first, std::size_t last) {
      table_.touch_pairs(touch, has_edges(list), first, last);
    });
  }
}

bool Response::resist(const ContactScene& scene, NearPairs& near, std::size_t i) {
  const Pair& pair = near.list.pairs[i];
  NearState& state = near.states[i];
  const ContactMesh& mesh = scene.points.meshes()[pair.mesh];
  const reference::BodyMotion& body = scene.clock.motions()[mesh.body];
  Encountered e = look_at(scene, near.list.points(i), body.h);
  const reference::Nearest found = nearest(pair.kind, e.x);
  const double l = length(found.r);
  const Vector direct = l > kTouching ? (1 / l) * found.r : near.normal(i);
  state.is_under =
      is_now_under(pair.kind, e, found.r, near.normal(i), state.is_under, mesh.thickness);
  const Vector along = state.is_under ? -1.0 * direct : direct;
  const double gap = (state.is_under ? -l : l) - mesh.thickness;
  const double sign = towards_cloth(pair.kind);
  const auto at = [&](std::uint32_t point) {
    return scene.points.is_of_cloth(point) ? scene.particles.position(point)
                                           : scene.points.vertex_now(scene.clock, point);
  };
  const Vector n = sign * along;
  near.set_normal(i, along);
  if (!(gap < 0)) return false;
  const Vector seen = pair.kind == PairKind::edges ? n : sign * direct;
  if (!is_in_place(pair.kind, found) ||
      is_ghost(scene.cloth, mesh, pair, e.x, found, seen, kLean, at))
    return false;

  Vector slip{}, relative{};
  double weight = 0;  // sum of W w^2
  std::array<double, 4> share{};
  for (std::size_t k = 0; k < 4; ++k) {
    slip = slip + (sign * found.weight[k]) * (e.x[k] - e.start[k]);
    if (!scene.points.is_of_cloth(e.points[k])) continue;
    share[k] = scene.model.inverse_mass[e.points[k]] * sign * found.weight[k];
    weight += share[k] * sign * found.weight[k];
  }
  if (!(weight > 0)) return false;
  weight = std::max(weight, least_weight(scene.model, e.points, scene.points));
  const reference::Stop stop = reference::stop({n, gap, slip}, body.friction, body.h, state.grip);
  if (!(stop.push > 0)) return false;
  state.is_touching = true;
  state.push += stop.push;
  TouchedSurface surface{.body = static_cast<std::uint32_t>(mesh.body)};
  Vector on_body{};
  for (std::size_t k = 0; k < 4; ++k) {
    relative = relative + (sign * found.weight[k]) * e.at[k].v;
    if (scene.points.is_of_cloth(e.points[k])) continue;
    surface.velocity = surface.velocity - (sign * found.weight[k]) * e.at[k].v;
    on_body = on_body - (sign * found.weight[k]) * e.x[k];
  }
  const reference::Slowed slow = reference::slow(n, relative, body.friction, state.grip);
  Vector impulse{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (share[k] == 0) continue;
    const double part = share[k] / weight;
    ContactParticle p = e.at[k];
    p.start = p.start + (part * stop.comes_out) * n;
    p.x = p.x + part * stop.by;
    p.v = p.v + part * slow.change;
    scene.particles.write(e.points[k], p);
    scene.particles.touch(e.points[k], surface);
    const double momentum = scene.model.mass[e.points[k]] * scene.particles.momentum_share();
    impulse = impulse + (momentum * part) * slow.change;
  }
  scene.impulses.add(mesh.body, body.to.centre, on_body, impulse, surface.velocity);
  const double l_change = length(slow.change);
  if (l_change > 0)
    scene.impulses.friction += length(impulse) / l_change * slow.taken * (stop.slid / body.h);
  return true;
}

void Response::remember(const ContactScene& scene, NearPairs& near, std::size_t list,
                        std::size_t i) {
  for (const std::uint32_t point : near.list.points(i)) {
    if (!scene.points.is_of_cloth(point)) continue;
    bool is_known = false;
    for (std::uint32_t link = first_link_[point]; link != kNoIndex && !is_known;
         link = links_[link].next)
      is_known = links_[link].list == list && links_[link].pair == i;
    if (is_known) continue;
    if (first_link_[point] == kNoIndex) linked_.push_back(point);
    links_.push_back(
        {static_cast<std::uint32_t>(list), static_cast<std::uint32_t>(i), first_link_[point]});
    first_link_[point] = static_cast<std::uint32_t>(links_.size() - 1);
  }
}

bool Response::hold(const ContactScene& scene, Near& near, std::uint32_t slot) {
  bool is_pushed = false;
  for (std::uint32_t link = slot < first_link_.size() ? first_link_[slot] : kNoIndex;
       link != kNoIndex; link = links_[link].next) {
    is_pushed = resist(scene, near[links_[link].list], links_[link].pair) || is_pushed;
  }
  return is_pushed;
}

double Response::deepest(const ContactScene& scene, Near& near, Team& team) {
  find_touching(scene, near, team);
  double deepest = 0;
  for (std::size_t list = 0; list < kPairLists; ++list) {
    for (std::size_t block = 0; block < touching_[list].size(); ++block) {
      for (std::uint32_t bits = touching_[list][block]; bits != 0; bits &= bits - 1) {
        const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
        deepest = std::max(deepest, depth_of(scene, near[list], i));
      }
    }
  }
  return deepest;
}

double Response::depth_of(const ContactScene& scene, const NearPairs& near, std::size_t i) const {
  const Pair& pair = near.list.pairs[i];
  const ContactMesh& mesh = scene.points.meshes()[pair.mesh];
  const Encountered e = look_at(scene, near.list.points(i), scene.clock.motions()[mesh.body].h);
  const reference::Nearest found = nearest(pair.kind, e.x);
  const double l = length(found.r);
  const bool is_under =
      is_now_under(pair.kind, e, found.r, near.normal(i), near.states[i].is_under, mesh.thickness);
  const auto at = [&](std::uint32_t point) {
    return scene.points.is_of_cloth(point) ? scene.particles.position(point)
                                           : scene.points.vertex_now(scene.clock, point);
  };
  const Vector direct = towards_cloth(pair.kind) * kernels::direction(found.r, l);
  const Vector seen = pair.kind == PairKind::edges && is_under ? -1.0 * direct : direct;
  if (!is_in_place(pair.kind, found) ||
      is_ghost(scene.cloth, mesh, pair, e.x, found, seen, kLean, at))
    return 0;
  return mesh.thickness - (is_under ? -l : l);
}

std::size_t Response::bytes() const {
  return bytes_of(touching_[0]) + bytes_of(touching_[1]) + bytes_of(asked_) +
         is_asked_.capacity() / 8 + bytes_of(first_link_) + bytes_of(linked_) + bytes_of(links_);
}

}  // namespace weft
