#include "engine/bodies/free_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/public_vectors.h"

namespace weft {

using kernels::Vector;

Pose pose_of(const BodyMass& mass, const FreeMotion& motion) {
  const reference::Placement at = placement_of(motion.rotation, motion.centre);
  const Vector origin = motion.centre - at.turned(to_internal(mass.centre));
  return {to_public(origin), motion.rotation};
}

Vector BodyInertia::momentum(const Rotation& rotation, Vector spin) const {
  const reference::Placement at = placement_of(rotation, {});
  return at.turned(tensor_ * at.turned_back(spin));
}

Vector BodyInertia::spin(const Rotation& rotation, Vector momentum) const {
  const reference::Placement at = placement_of(rotation, {});
  return at.turned(inverse_ * at.turned_back(momentum));
}

/// By the method of Runge and Kutta, of the fourth order: the momentum is exact, and what the
/// energy loses is far below what floats hold.
Rotation BodyInertia::flight(const Rotation& from, Vector momentum, double time) const {
  constexpr double kMostTurn = 0.05;  // rad
  constexpr double kMostParts = 1000;
  const double angle = length(spin(from, momentum)) * std::abs(time);
  const double parts = std::clamp(std::ceil(angle / kMostTurn), 1.0, kMostParts);
  const double h = time / parts;
  Rotation q = from;
  const auto rate = [&](const Rotation& at) {
    const Vector w = 0.5 * spin(normalized(at), momentum);
    return product({w.x, w.y, w.z, 0}, at);
  };
  const auto along = [](const Rotation& a, double share, const Rotation& b) {
    return Rotation{a.x + share * b.x, a.y + share * b.y, a.z + share * b.z, a.w + share * b.w};
  };
  for (double part = 0; part < parts; ++part) {
    const Rotation k1 = rate(q), k2 = rate(along(q, h / 2, k1)), k3 = rate(along(q, h / 2, k2)),
                   k4 = rate(along(q, h, k3));
    q = along(along(q, h / 6, along(k1, 1, k4)), h / 3, along(k2, 1, k3));
    q = normalized(q);
  }
  return q;
}

SymmetricTensor BodyInertia::turned_inverse(const Rotation& rotation) const {
  const reference::Placement at = placement_of(rotation, {});
  std::array<Vector, 3> column{};
  const Vector unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 3; ++i) column[i] = at.turned(inverse_ * at.turned_back(unit[i]));
  return {{column[0].x, column[1].y, column[2].z, column[2].y, column[2].x, column[1].x}};
}

}  // namespace weft
