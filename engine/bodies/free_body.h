/// Bodies that move by themselves: their state, and their flight.
#pragma once

#include <weft/body.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/bodies/body_mass.h"
#include "engine/bodies/body_shape.h"
#include "engine/bodies/pose.h"
#include "engine/saving/fields.h"

namespace weft {

/// The last substep of a body, on which the next one builds as that of a particle does.
struct FreePast {
  bool is_known = false;
  kernels::Vector velocity{}, momentum{};                // when it ended
  kernels::Vector velocity_before{}, momentum_before{};  // when it began
  kernels::Vector moved{}, turn{};                       // m, rad, in it

  friend void visit_fields(Is<FreePast> auto& past, auto& archive) {
    auto& [is_known, velocity, momentum, velocity_before, momentum_before, moved, turn] = past;
    archive(is_known, velocity, momentum, velocity_before, momentum_before, moved, turn);
  }
};

/// A motion about the centre of mass, in coordinates of the world.
struct FreeMotion {
  kernels::Vector centre{};  // m, of mass
  Rotation rotation{};
  kernels::Vector velocity{}, momentum{};  // m/s; kg m^2/s, angular
  FreePast past;
  std::vector<std::uint32_t> touching;  // slots that it touched when the last substep ended

  friend void visit_fields(Is<FreeMotion> auto& motion, auto& archive) {
    auto& [centre, rotation, velocity, momentum, past, touching] = motion;
    archive(centre, rotation, velocity, momentum, past, touching);
  }
};

/// A body that moves by itself, in a step.
struct FreeBody {
  std::uint32_t id = 0;
  std::shared_ptr<const BodyShape> shape;
  BodyMass mass;
  double thickness = 0, friction = 0;  // friction: with the cloth
  kernels::Vector force{}, moment{};
  FreeMotion motion;
};

/// Where the body is.
Pose pose_of(const BodyMass& mass, const FreeMotion& motion);

/// The mass of a body about its centre, turned into the world.
class BodyInertia {
 public:
  explicit BodyInertia(const BodyMass& mass) : tensor_{mass.inertia}, inverse_(inverse(tensor_)) {}

  kernels::Vector momentum(const Rotation& rotation, kernels::Vector spin) const;
  kernels::Vector spin(const Rotation& rotation, kernels::Vector momentum) const;
  /// Where a body with this angular momentum turns to in free flight. time: s, of either sign.
  Rotation flight(const Rotation& from, kernels::Vector momentum, double time) const;
  /// The inverse, turned.
  SymmetricTensor turned_inverse(const Rotation& rotation) const;

 private:
  SymmetricTensor tensor_, inverse_;
};

}  // namespace weft
