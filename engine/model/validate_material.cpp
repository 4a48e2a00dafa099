#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/hypotenuse.h"
#include "engine/model/pressures.h"
#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"
#include "kernels/reference/membrane.h"

namespace weft {
namespace {

/// All of them, and no two alike.
Result<void> validate_corners(const std::string& field, std::span<const std::uint32_t> corners,
                              std::size_t particles) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (auto r = validate_particle(element(field, i), corners[i], particles); !r) return r;
    if (std::ranges::find(corners.first(i), corners[i]) != corners.begin() + static_cast<long>(i)) {
      return refuse(element(field, i), "particle is listed twice", std::to_string(corners[i]));
    }
  }
  return {};
}

/// m, of a triangle of fabric: its area has a square.
constexpr double kLeastSide = 1e-75, kMostSide = 1e75;

/// Weights cancel but for their rounding.
constexpr double kLeastSum = 1e-9;

Result<void> validate_bending(std::size_t index, const BendingElement& b, std::size_t particles) {
  const std::string field = element("bending", index);
  const bool has_three = b.particles[3] == kNoIndex;
  const auto corners = std::span(b.particles).first(has_three ? 3 : 4);
  if (auto r = validate_corners(field + ".particles", corners, particles); !r) return r;
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!std::isfinite(b.weights[i]) || std::abs(b.weights[i]) > kMostSquared) {
      return refuse(element(field + ".weights", i), "must be finite", number(b.weights[i]));
    }
    sum += b.weights[i];
    size += std::abs(b.weights[i]);
  }
  if (has_three && b.weights[3] != 0) {
    return refuse(element(field + ".weights", 3), "has no particle", number(b.weights[3]));
  }
  if (size == 0 || std::abs(sum) > kLeastSum * size) {
    return refuse(field + ".weights", "must sum to 0 and not all be 0", number(sum));
  }
  if (auto r = validate_not_negative(field + ".rest", b.rest); !r) return r;
  if (!std::isfinite(b.fold) || std::abs(b.fold) > kMostSquared)
    return refuse(field + ".fold", "must be finite", number(b.fold));
  if (has_three && b.fold != 0) {
    return refuse(field + ".fold", "three particles have no side", number(b.fold));
  }
  if (b.rest != 0 && b.fold != 0)
    return refuse(field + ".fold", "has a rest besides", number(b.fold));
  if (auto r = validate_positive(field + ".compliance", b.compliance); !r) return r;
  return validate_square(field + ".compliance", b.compliance);
}

/// The least ratio of twice the area of a triangle to two of its sides: below this it is rounding.
constexpr double kLeastSine = 1e-9;

Result<void> validate_rest(const std::string& field, const MembraneElement& e) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [u, v] = e.rest[k];
    if (std::isfinite(u) && std::isfinite(v)) continue;
    return refuse(element(field, k), "must be finite", number(u) + ", " + number(v));
  }
  double sides[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [u, v] = e.rest[k];
    const auto& [next_u, next_v] = e.rest[(k + 1) % 3];
    sides[k] = hypotenuse(next_u - u, next_v - v);
    if (sides[k] >= kLeastSide && sides[k] <= kMostSide) continue;
    return refuse(element(field, k), "must be from 1e-75 to 1e75 m away from the next corner",
                  number(sides[k]));
  }
  const double area = reference::shape_of(e.rest).area;
  if (area > kLeastSine * sides[0] * sides[2]) return {};
  return refuse(field, "the corners lie on a line, the area must be greater than 0", number(area));
}

Result<void> validate_membrane(std::size_t index, const MembraneElement& e, std::size_t particles) {
  const std::string field = element("membrane", index);
  if (auto r = validate_corners(field + ".particles", e.particles, particles); !r) return r;
  if (auto r = validate_rest(field + ".rest", e); !r) return r;
  for (const auto& [law, stiffness] :
       {std::pair{".warp", e.warp}, std::pair{".weft", e.weft}, std::pair{".shear", e.shear}}) {
    if (auto r = validate_not_negative(field + law, stiffness); !r) return r;
  }
  return validate_kind(field + ".kind", e.kind);
}

Result<void> validate_air(const Air& air, std::size_t particles) {
  for (std::size_t i = 0; i < air.triangles.size(); ++i) {
    const std::string field = element("air.triangles", i);
    if (auto r = validate_corners(field, air.triangles[i], particles); !r) return r;
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

Result<void> validate_seams(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.seams.size(); ++i) {
    const Seam& seam = d.seams[i];
    const std::string field = element("seams", i);
    if (auto r = validate_particle(field + ".a", seam.a, d.positions.size()); !r) return r;
    if (auto r = validate_particle(field + ".b", seam.b, d.positions.size()); !r) return r;
    if (seam.a == seam.b) return refuse(field, "sews a particle to itself", std::to_string(seam.a));
    if (auto r = validate_positive(field + ".time", seam.time); !r) return r;
    if (!(seam.max_force > 0))
      return refuse(field + ".max_force", "must be greater than 0, or infinite",
                    number(seam.max_force));
  }
  return {};
}

Result<void> validate_material(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.membrane.size(); ++i) {
    if (auto r = validate_membrane(i, d.membrane[i], d.positions.size()); !r) return r;
  }
  for (std::size_t i = 0; i < d.bending.size(); ++i) {
    if (auto r = validate_bending(i, d.bending[i], d.positions.size()); !r) return r;
  }
  for (std::size_t i = 0; i < d.surface.size(); ++i) {
    if (auto r = validate_corners(element("surface", i), d.surface[i], d.positions.size()); !r)
      return r;
  }
  if (auto r = validate_damping(d.damping); !r) return r;
  if (auto r = validate_not_negative("friction", d.friction); !r) return r;
  const auto place = [&](std::uint32_t i) { return to_internal(d.positions[i]); };
  if (auto r = validate_pressures(d.pressures, {}, d.surface, place); !r) return r;
  if (auto r = validate_self_contact(d.self_contact, !d.surface.empty() || !d.constraints.empty());
      !r)
    return r;
  return validate_air(d.air, d.positions.size());
}

}  // namespace weft
