/// Bodies with a mass in tests: where they are, and what they keep.
#pragma once

#include <weft/weft.h>

#include "tests/support/body_meshes.h"
#include "tests/support/vectors.h"

namespace weft::test {

/// A body with a mass in a cloth.
struct Free {
  std::uint32_t id = 0;
  BodyMass mass;

  Pose pose(const Cloth& cloth) const { return cloth.body_pose(id).value(); }
  BodyVelocity velocity(const Cloth& cloth) const { return cloth.body_velocity(id).value(); }
  Vec3 centre(const Cloth& cloth) const {
    const Pose at = pose(cloth);
    return at.position + turned(at.rotation, mass.centre);
  }
  Vec3 momentum(const Cloth& cloth) const { return mass.mass * velocity(cloth).linear; }
  /// About its centre.
  Vec3 spin_momentum(const Cloth& cloth) const {
    const Rotation r = pose(cloth).rotation;
    const Vec3 w = turned({-r.x, -r.y, -r.z, r.w}, velocity(cloth).angular);
    const auto& [xx, yy, zz, yz, zx, xy] = mass.inertia;
    return turned(r, {xx * w.x + xy * w.y + zx * w.z, xy * w.x + yy * w.y + yz * w.z,
                      zx * w.x + yz * w.y + zz * w.z});
  }
  double kinetic(const Cloth& cloth) const {
    const auto [linear, angular] = velocity(cloth);
    return 0.5 * (mass.mass * dot(linear, linear) + dot(spin_momentum(cloth), angular));
  }
  double energy(const Cloth& cloth, double gravity) const {
    return kinetic(cloth) + mass.mass * gravity * centre(cloth).y;
  }
};

inline BodyMass body_mass(const BodyShape& shape, double mass) {
  const double of_one = weft::mass_of(shape, 1).value().mass;
  return weft::mass_of(shape, mass / of_one).value();
}

inline Free add_free(Cloth& cloth, const ShapeDescription& shape, double mass, const Pose& pose,
                     double friction = 0.3) {
  const auto built = shape_of(shape);
  const BodyMass of = body_mass(*built, mass);
  return {test::add(cloth, {.shape = built, .pose = pose, .friction = friction, .mass = of}), of};
}

}  // namespace weft::test
