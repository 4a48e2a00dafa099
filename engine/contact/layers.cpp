#include "engine/contact/layers.h"

#include <algorithm>
#include <limits>

#include "engine/contact/respond.h"
#include "engine/tuning.h"

namespace weft::layers {

using kernels::Vector;

namespace {

/// m, beyond the thickness, that a pair is to have in this substep.
double target_of(double began, double thickness, double h) {
  const double slack = tuning::kLayerSlack * thickness;
  if (began >= -slack) return std::min(began, 0.0);
  const double speed = std::min(reference::kFastestRecovery, (-slack - began) / tuning::kLayerTime);
  return std::min(-slack, began + h * speed);
}

/// m, of the first feature beside the second since the substep began.
struct Slip {
  double approach = 0;
  Vector along{};
};

Slip slip_of(const Encounter& e) {
  Vector slip{};
  for (std::size_t k = 0; k < 4; ++k) slip = slip + e.nearest.weight[k] * (e.x[k] - e.start[k]);
  const double approach = -dot(e.normal, slip);
  return {approach, slip + approach * e.normal};
}

void begin(const ContactScene& scene, NearState& state, double began) {
  state.is_touching = true;
  state.target = target_of(began, state.thickness, scene.clock.h());
  state.is_blow = began > tuning::kLayerMeeting * state.thickness;
}

/// How much of a push each point takes.
struct Shares {
  std::array<double, 4> of{};
  double weight = 0;  // 1/kg: sum of W w^2
};

Shares shares_of(const ContactScene& scene, const Encounter& e, const std::array<bool, 4>& counts) {
  Shares shares;
  double& weight = shares.weight;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = e.nearest.weight[k];
    if (counts[k]) weight += scene.points.inverse_mass(e.points[k]) * w * w;
  }
  if (!(weight > 0)) return shares;
  weight = std::max(weight, least_weight(scene.points, e.points));
  for (std::size_t k = 0; k < 4; ++k)
    shares.of[k] = scene.points.inverse_mass(e.points[k]) * e.nearest.weight[k] / weight;
  return shares;
}

using Velocities = std::array<Vector, 4>;

Velocities velocities_of(const ContactScene& scene, const Encounter& e) {
  Velocities v;
  for (std::size_t k = 0; k < 4; ++k) v[k] = scene.particles.read(e.points[k]).v;
  return v;
}

/// The blow, as far as velocities are concerned.
void slow(const ContactScene& scene, const Encounter& e, const Shares& shares, double friction,
          reference::Grip& grip) {
  std::array<ContactParticle, 4> at;
  Vector relative{};
  for (std::size_t k = 0; k < 4; ++k) {
    at[k] = scene.read_moving(e.points[k]);
    relative = relative + e.nearest.weight[k] * at[k].v;
  }
  const reference::Slowed slowed =
      reference::slow(e.normal, relative, friction, scene.clock.h(), grip);
  for (std::size_t k = 0; k < 4; ++k) {
    if (shares.of[k] == 0) continue;
    at[k].v = at[k].v + shares.of[k] * slowed.change;
    scene.particles.write(e.points[k], at[k]);
  }
}

/// m/s, at which the features come nearer to each other.
double closing(const ContactScene& scene, const Encounter& e) {
  double speed = 0;
  for (std::size_t k = 0; k < 4; ++k)
    speed -= e.nearest.weight[k] * dot(e.normal, scene.read_moving(e.points[k]).v);
  return speed;
}

/// Gives back what a blow has taken of the speed at which layers now come apart, and the friction
/// that went with it.
void speed_up(const ContactScene& scene, const Encounter& e, const Shares& free,
              const Shares& shares, double friction, reference::Grip& grip) {
  Vector relative{};
  for (std::size_t k = 0; k < 4; ++k)
    relative = relative + e.nearest.weight[k] * scene.read_moving(e.points[k]).v;
  const double apart = dot(relative, e.normal), speed = std::min(apart, grip.stopped);
  if (!(speed > 0)) return;
  grip.stopped -= speed;
  const Vector sliding = relative - apart * e.normal;
  const double l = length(sliding),
               faster = std::clamp(grip.slowed - friction * grip.stopped, 0.0, l);
  const Vector along = l > 0 ? (faster / l) * sliding : Vector{};
  grip.slowed -= faster;
  for (std::size_t k = 0; k < 4; ++k) {
    if (shares.of[k] == 0) continue;
    ContactParticle p = scene.read_moving(e.points[k]);
    p.v = p.v - (free.of[k] * speed) * e.normal + shares.of[k] * along;
    scene.particles.write(e.points[k], p);
  }
}

/// m, of a push that takes that speed.
double way_of(const ContactScene& scene, double speed) {
  return speed * scene.clock.h() / scene.particles.momentum_share();
}

/// Takes the speed at which layers that lie on each other would go on to come nearer, where ways
/// make nothing faster.
void settle(const ContactScene& scene, const Encounter& e, const std::array<bool, 4>& is_free) {
  const double speed = closing(scene, e);
  const Shares shares = shares_of(scene, e, is_free);
  if (!(speed > 0) || !(shares.weight > 0)) return;
  for (std::size_t k = 0; k < 4; ++k) {
    if (shares.of[k] == 0 || !is_free[k]) continue;
    ContactParticle p = scene.particles.read(e.points[k]);
    p.v = p.v + (shares.of[k] * speed) * e.normal;
    scene.particles.write(e.points[k], p);
  }
}

/// Moves the points by their shares of both, and tells which of them no body has held. before_blow:
/// of a blow, which is a jolt by what is left of it once bodies have held the points.
std::array<bool, 4> push(const ContactScene& scene, Encounter& e, const Shares& shares, Vector by,
                         Vector comes_out, const Velocities* before_blow) {
  std::array<bool, 4> is_free{true, true, true, true};
  for (std::size_t k = 0; k < 4; ++k) {
    const double share = shares.of[k];
    if (share == 0) continue;
    const std::uint32_t point = e.points[k];
    if (before_blow != nullptr) {
      ContactParticle p = scene.particles.read(point);
      p.x = p.x + share * by;
      scene.particles.write(point, p);
      scene.particles.push(point, {}, {});
      scene.particles.jolt(point, scene.particles.read(point).v - (*before_blow)[k]);
    } else {
      scene.particles.push(point, share * by, share * comes_out);
    }
    const Vector x = scene.particles.position(point), moved = x - e.x[k];
    e.x[k] = x;
    e.start[k] = scene.particles.start(point);
    e.gap += e.nearest.weight[k] * dot(e.normal, moved);
    is_free[k] = dot(moved, e.normal) / (share * dot(by + comes_out, e.normal)) > 0.5;
  }
  return is_free;
}

/// Bodies of a closed form have given points that stay what is taken back of them (kg m).
void unload(const ContactScene& scene, const Encounter& e, const std::array<bool, 4>& is_off,
            double taken) {
  const double share = scene.particles.momentum_share(), per_way = share * share / scene.clock.h();
  for (std::size_t k = 0; k < 4; ++k) {
    if (is_off[k] || scene.points.inverse_mass(e.points[k]) == 0) continue;
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t touched = 0;
    for (std::size_t body = 0; body < scene.clock.bodies().size(); ++body) {
      if (scene.clock.bodies()[body].shape->mesh() != nullptr) continue;
      const reference::BodyMotion& motion = scene.clock.motions()[body];
      const double gap = gap_of(motion.solid, motion.thickness, motion.to.from_place(e.x[k])).gap;
      if (gap >= nearest) continue;
      nearest = gap;
      touched = body;
    }
    if (nearest == std::numeric_limits<double>::infinity()) continue;
    const reference::BodyMotion& motion = scene.clock.motions()[touched];
    scene.impulses.add(touched, motion.to.centre, e.x[k],
                       (per_way * e.nearest.weight[k] * taken) * e.normal,
                       motion.velocity_at(e.x[k]));
  }
}

}  // namespace

bool resist(const ContactScene& scene, Encounter& e, NearState& state) {
  const Slip slip = slip_of(e);
  if (!state.is_touching) begin(scene, state, e.gap + slip.approach);
  const double push_by = state.target - e.gap;
  if (!(push_by > 0)) return false;
  const bool is_mended = scene.particles.is_mended();
  double stays_out = state.is_blow ? push_by : std::min(push_by, std::max(0.0, slip.approach));
  if (stays_out < push_by && !is_mended)
    stays_out = std::clamp(way_of(scene, closing(scene, e)), stays_out, push_by);
  state.push += push_by;
  const double friction = scene.points.surfaces()[kClothSurface].friction, end = e.gap + push_by;
  std::array<bool, 4> counts{true, true, true, true};
  double whole = 0;
  for (int visit = 0; visit < 2; ++visit) {
    const Shares shares = shares_of(scene, e, counts);
    const double left = (end - e.gap) / push_by;
    if (!(shares.weight > 0) || !(left > 0)) break;
    if (visit == 0) whole = shares.weight;
    state.given += left * stays_out / shares.weight;
    state.grip.pushed += whole / shares.weight * left * stays_out;
    double held = 0;
    if (visit == 0) {
      held =
          reference::held_share(length(slip.along), friction * state.grip.pushed, state.grip.held);
    }
    Velocities before;
    if (state.is_blow) {
      before = velocities_of(scene, e);
      slow(scene, e, shares, friction, state.grip);
    }
    counts = push(scene, e, shares, left * stays_out * e.normal - held * slip.along,
                  left * (push_by - stays_out) * e.normal, state.is_blow ? &before : nullptr);
    if (counts == std::array{true, true, true, true}) break;
  }
  if (is_mended && !state.is_blow) settle(scene, e, counts);
  return true;
}

bool take_back(const ContactScene& scene, Encounter& e, NearState& state) {
  const double open = tuning::kTakenBack * (e.gap - state.target);
  if (!(open > 0) || scene.particles.is_mended()) return false;
  std::array<bool, 4> is_off{};
  for (std::size_t k = 0; k < 4; ++k) is_off[k] = !scene.particles.is_on_body(e.points[k]);
  Shares free = shares_of(scene, e, is_off);
  if (!(free.weight > 0)) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!is_off[k]) free.of[k] = 0;
  }
  const Shares shares = shares_of(scene, e, {true, true, true, true});
  const double back = std::min(open, state.given * free.weight);
  const double friction = scene.points.surfaces()[kClothSurface].friction;
  state.given -= back / free.weight;
  state.push -= back;
  state.grip.pushed = std::max(0.0, state.grip.pushed - shares.weight / free.weight * back);
  e.read_start(scene);
  const Vector along = slip_of(e).along;
  const double l = length(along),
               slides = std::clamp(state.grip.held - friction * state.grip.pushed, 0.0, l);
  state.grip.held -= slides;
  Velocities before;
  if (state.is_blow) {
    before = velocities_of(scene, e);
    speed_up(scene, e, free, shares, friction, state.grip);
  }
  const Velocities* of_blow = state.is_blow ? &before : nullptr;
  push(scene, e, free, -back * e.normal, {}, of_blow);
  if (slides > 0) {
    if (state.is_blow) before = velocities_of(scene, e);
    push(scene, e, shares, (slides / l) * along, {}, of_blow);
  }
  unload(scene, e, is_off, back / free.weight);
  return true;
}

}  // namespace weft::layers
