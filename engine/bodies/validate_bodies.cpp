#include "engine/bodies/validate_bodies.h"

#include <weft/shape_fields.h>

#include <cmath>

#include "engine/bodies/body_mass.h"
#include "engine/bodies/body_shape.h"
#include "engine/validation.h"

namespace weft {

Result<void> validate(const Pose& pose) {
  if (!finite(pose.position)) return refuse("pose.position", "must be finite", text(pose.position));
  const Rotation& q = pose.rotation;
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (square > 0 && std::isfinite(square)) return {};
  return refuse("pose.rotation", "must be finite and not 0",
                number(q.x) + ", " + number(q.y) + ", " + number(q.z) + ", " + number(q.w));
}

Result<void> validate(const Body& body) {
  if (!body.shape) return refuse("shape", "must not be null", "null");
  if (auto r = validate(body.pose); !r) return r;
  if (auto r = validate_not_negative("thickness", body.thickness); !r) return r;
  if (auto r = validate_not_negative("friction", body.friction); !r) return r;
  if (!body.mass) return {};
  if (!body.shape->moments()) {
    return refuse("mass", "must be of " + shapes_with_mass(),
                  kind_of(body.shape->description()).text);
  }
  return validate(*body.mass);
}

}  // namespace weft
