/// Masses and inertias of bodies that move by themselves.
#pragma once

#include <weft/body.h>

#include <array>
#include <string>

#include "kernels/vectors.h"

namespace weft {

/// A symmetric matrix: xx, yy, zz, yz, zx, xy.
struct SymmetricTensor {
  std::array<double, 6> of{};

  kernels::Vector operator*(kernels::Vector v) const {
    return {of[0] * v.x + of[5] * v.y + of[4] * v.z, of[5] * v.x + of[1] * v.y + of[3] * v.z,
            of[4] * v.x + of[3] * v.y + of[2] * v.z};
  }
};
SymmetricTensor inverse(const SymmetricTensor& matrix);

/// Whether there is a body of this mass and inertia.
Result<void> validate(const BodyMass& mass);

/// "a ball, a capsule or a hull"
std::string shapes_with_mass();

}  // namespace weft
