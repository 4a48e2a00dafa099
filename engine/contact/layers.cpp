#include "engine/contact/layers.h"

#include <algorithm>

#include "engine/contact/respond.h"

namespace weft::layers {

using kernels::Vector;

namespace {

constexpr double kLayerSlack = 0.05, kLayerMeeting = 0.02;
constexpr double kLayerTime = 3e-3;

/// m, beyond the thickness, that a pair is to have in this substep.
double target_of(double began, double thickness, double h) {
  const double slack = kLayerSlack * thickness;
  if (began >= -slack) return std::min(began, 0.0);
  const double speed = std::min(reference::kFastestRecovery, (-slack - began) / kLayerTime);
  return std::min(-slack, began + h * speed);
}

/// How much of a push each point takes.
struct Shares {
  std::array<double, 4> of{};
};

Shares shares_of(const ContactScene& scene, const Encounter& e, const std::array<bool, 4>& counts) {
  double weight = 0;  // sum of W w^2
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = e.nearest.weight[k];
    if (counts[k]) weight += scene.points.inverse_mass(e.points[k]) * w * w;
  }
  Shares shares;
  if (!(weight > 0)) return shares;
  weight = std::max(weight, least_weight(scene.points, e.points));
  for (std::size_t k = 0; k < 4; ++k)
    shares.of[k] = scene.points.inverse_mass(e.points[k]) * e.nearest.weight[k] / weight;
  return shares;
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
  const reference::Slowed slowed = reference::slow(e.normal, relative, friction, grip);
  for (std::size_t k = 0; k < 4; ++k) {
    if (shares.of[k] == 0) continue;
    const Vector faster = shares.of[k] * slowed.change;
    at[k].v = at[k].v + faster;
    scene.particles.write(e.points[k], at[k]);
    scene.particles.jolt(e.points[k], faster);
  }
}

/// Moves the points by their shares of both, and tells which of them a body did not let go.
std::array<bool, 4> push(const ContactScene& scene, Encounter& e, const Shares& shares, Vector by,
                         Vector comes_out, bool is_blow) {
  std::array<bool, 4> is_free{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double share = shares.of[k];
    if (share == 0) continue;
    const std::uint32_t point = e.points[k];
    if (is_blow) {
      ContactParticle p = scene.particles.read(point);
      p.x = p.x + share * by;
      scene.particles.write(point, p);
      scene.particles.push(point, {}, {});
    } else {
      scene.particles.push(point, share * by, share * comes_out);
    }
    const Vector x = scene.particles.position(point), moved = x - e.x[k];
    e.x[k] = x;
    e.start[k] = scene.particles.start(point);
    scene.points.set_place(point, x);
    e.gap += e.nearest.weight[k] * dot(e.normal, moved);
    is_free[k] = dot(moved, e.normal) / share > 0.5 * dot(by + comes_out, e.normal);
  }
  return is_free;
}

}  // namespace

bool resist(const ContactScene& scene, Encounter& e, NearState& state) {
  const double friction = scene.points.surfaces()[kClothSurface].friction;
  bool is_pushed = false;
  std::array<bool, 4> counts{true, true, true, true};
  for (int visit = 0; visit < 2; ++visit) {
    const Shares shares = shares_of(scene, e, counts);
    if (shares.of == std::array<double, 4>{}) break;
    Vector slip{};
    for (std::size_t k = 0; k < 4; ++k) slip = slip + e.nearest.weight[k] * (e.x[k] - e.start[k]);
    const double approach = -dot(e.normal, slip), began = e.gap + approach;
    if (!state.is_touching) {
      state.target = target_of(began, state.thickness, scene.clock.h());
      state.is_blow = began > kLayerMeeting * state.thickness;
    }
    const double push_by = state.target - e.gap;
    if (!(push_by > 0)) break;
    is_pushed = state.is_touching = true;
    const double stays_out = state.is_blow ? push_by : std::min(push_by, std::max(0.0, approach));
    state.push += push_by;
    state.grip.pushed += stays_out;
    const Vector along = slip + approach * e.normal;
    const double held =
        reference::held_share(length(along), friction * state.grip.pushed, state.grip.held);
    if (state.is_blow) slow(scene, e, shares, friction, state.grip);
    const auto is_free = push(scene, e, shares, stays_out * e.normal - held * along,
                              (push_by - stays_out) * e.normal, state.is_blow);
    bool is_held = false;
    for (std::size_t k = 0; k < 4; ++k) {
      is_held = is_held || (shares.of[k] != 0 && !is_free[k]);
      counts[k] = is_free[k];
    }
    if (!is_held) break;
  }
  return is_pushed;
}

}  // namespace weft::layers
