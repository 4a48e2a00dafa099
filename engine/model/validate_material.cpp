#include <utility>

#include "engine/model/pressures.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

Result<void> validate_air(const Air& air, std::size_t particles) {
  const FieldName triangles("air.triangles");
  for (std::size_t i = 0; i < air.triangles.size(); ++i) {
    if (auto r = validate_corners(triangles.at(i), air.triangles[i], particles); !r) return r;
  }
  const ChangedAir numbers{air.density, air.drag, air.lift, air.ram};
  if (auto r = weft::validate_air(numbers, !air.triangles.empty()); !r) return r;
  return validate_wind(air.wind);
}

}  // namespace

Result<void> validate_air(const ChangedAir& air, bool has_triangles) {
  if (auto r = validate_not_negative("air.density", air.density); !r) return r;
  for (const auto& [field, value] :
       {std::pair{"air.drag", air.drag}, std::pair{"air.lift", air.lift},
        std::pair{"air.ram", air.ram}}) {
    if (auto r = validate_not_negative(field, value); !r) return r;
    if (value > 0 && !has_triangles)
      return refuse(field, "given without air.triangles, nothing would feel it", number(value));
  }
  return {};
}

Result<void> validate_wind(Vec3 wind) {
  if (finite(wind)) return {};
  return refuse("air.wind", "must be finite", text(wind));
}

Result<void> validate_self_contact(const SelfContact& contact, bool has_features) {
  if (auto r = validate_not_negative("self_contact.friction", contact.friction); !r) return r;
  if (contact.on && !has_features)
    return refuse("self_contact", "needs triangles of `surface`, or constraints that are threads",
                  "none");
  if (contact.on) return validate_positive("self_contact.thickness", contact.thickness);
  return validate_not_negative("self_contact.thickness", contact.thickness);
}

Result<void> validate_damping(const Damping& damping) {
  if (auto r = validate_not_negative("damping.stretch", damping.stretch); !r) return r;
  if (auto r = validate_not_negative("damping.bending", damping.bending); !r) return r;
  return validate_not_negative("damping.motion", damping.motion);
}

Result<void> validate_material(const SceneDescription& d) {
  const FieldName surface("surface");
  for (std::size_t i = 0; i < d.surface.size(); ++i) {
    if (auto r = validate_corners(surface.at(i), d.surface[i], d.positions.size()); !r) return r;
  }
  if (auto r = validate_damping(d.damping); !r) return r;
  const auto place = [&](std::uint32_t i) { return to_internal(d.positions[i]); };
  if (auto r = validate_pressures(d.pressures, {}, d.surface, place); !r) return r;
  if (auto r = validate_self_contact(d.self_contact, !d.surface.empty() || !d.constraints.empty());
      !r)
    return r;
  return validate_air(d.air, d.positions.size());
}

}  // namespace weft
