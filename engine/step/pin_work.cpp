#include "engine/step/pin_work.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/step/motion.h"

namespace weft {
namespace {

using kernels::Vector;

/// work(where it is halfway, its velocity); a sphere that touches nothing is left out.
template <class Work>
void for_each_pin(const State& s, const std::vector<std::uint32_t>& pins, double h, Work&& work) {
  for (const std::uint32_t slot : pins) {
    if (touches_nothing(*s.model, s.contacts, slot)) continue;
    work(s.position[slot] + (0.5 * h) * s.velocity[slot], s.velocity[slot]);
  }
  const AnchorTravel anchors = s.anchors.travel();
  for (std::size_t i = 0; i < anchors.from.size(); ++i) {
    const Vector from = anchors.from[i].point, to = anchors.to[i].point;
    work(0.5 * (from + to), (1 / h) * (to - from));
  }
}

/// A symmetric matrix of 3 x 3.
struct Inertia {
  Vector x{}, y{}, z{};  // columns

  /// Adds a unit mass at r.
  void add(Vector r) {
    const double square = dot(r, r);
    x = x + Vector{square, 0, 0} - r.x * r;
    y = y + Vector{0, square, 0} - r.y * r;
    z = z + Vector{0, 0, square} - r.z * r;
  }
  /// A body that is a line has no inertia about itself, and does not spin about it.
  Vector spin_of(Vector angular_momentum) const {
    constexpr double kLine = 1e-9;
    const double least = kLine * (x.x + y.y + z.z);
    if (!(least > 0)) return {};
    const Vector a = x + Vector{least, 0, 0}, b = y + Vector{0, least, 0},
                 c = z + Vector{0, 0, least};
    const Vector bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    const double over = 1 / dot(a, bc);
    return {over * dot(bc, angular_momentum), over * dot(ca, angular_momentum),
            over * dot(ab, angular_momentum)};
  }
};

bool any_under_way(const State& s, double h) {
  bool any = false;
  for_each_pin(s, s.model->pins, h, [&](Vector, Vector v) { any = any || dot(v, v) > 0; });
  return any;
}

double largest_stray(const PinMotion& pins, const State& s, double h) {
  double most = 0;
  for_each_pin(s, s.model->pins, h,
               [&](Vector x, Vector v) { most = std::max(most, length(v - pins.at(x))); });
  return most;
}

}  // namespace

PinMotion motion_of_pins(const State& s, double h) {
  PinMotion pins;
  if (!any_under_way(s, h)) return pins;
  const auto for_each = [&](auto&& work) { for_each_pin(s, s.model->holds, h, work); };
  double count = 0;
  for_each([&](Vector x, Vector v) {
    pins.centre = pins.centre + x;
    pins.velocity = pins.velocity + v;
    ++count;
  });
  if (count > 0) {
    pins.centre = (1 / count) * pins.centre;
    pins.velocity = (1 / count) * pins.velocity;
    Inertia inertia;
    Vector angular_momentum{};
    for_each([&](Vector x, Vector v) {
      const Vector r = x - pins.centre;
      inertia.add(r);
      angular_momentum = angular_momentum + cross(r, v - pins.velocity);
    });
    pins.spin = inertia.spin_of(angular_momentum);
  }
  pins.stray = largest_stray(pins, s, h);
  return pins;
}

double work_of(const PinMotion& pins, const State& s, double h) {
  Vector linear{}, angular{};
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0 || touches_nothing(*s.model, s.contacts, slot)) continue;
    const Vector j =
        (1 / w) * (s.next_velocity[slot] - s.velocity[slot] - h * acceleration(s, slot));
    linear = linear + j;
    angular = angular + cross(0.5 * (s.position[slot] + s.solved[slot]) - pins.centre, j);
  }
  for (const BodyImpulse& body : s.body_report.impulses) {
    linear = linear - body.linear;
    angular = angular - body.angular - cross(body.centre - pins.centre, body.linear);
  }
  return dot(pins.velocity, linear) + dot(pins.spin, angular);
}

double stray_energy(const PinMotion& pins, const State& s) {
  double mass = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w > 0 && !touches_nothing(*s.model, s.contacts, slot)) mass += 1 / w;
  }
  return 0.5 * mass * pins.stray * pins.stray;
}

}  // namespace weft
