#include <algorithm>
#include <cmath>
#include <span>

#include "engine/model/validate.h"
#include "engine/model/validation.h"

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
  if (auto r = validate_positive(field + ".compliance", b.compliance); !r) return r;
  return validate_square(field + ".compliance", b.compliance);
}

Result<void> validate_air(const Air& air, std::size_t particles) {
  for (std::size_t i = 0; i < air.triangles.size(); ++i) {
    const std::string field = element("air.triangles", i);
    if (auto r = validate_corners(field, air.triangles[i], particles); !r) return r;
  }
  if (auto r = validate_not_negative("air.density", air.density); !r) return r;
  if (auto r = validate_not_negative("air.drag", air.drag); !r) return r;
  if (auto r = validate_not_negative("air.lift", air.lift); !r) return r;
  if (air.triangles.empty() && (air.drag > 0 || air.lift > 0)) {
    return refuse("air.drag", "given without air.triangles, nothing would feel it",
                  number(air.drag));
  }
  return validate_wind(air.wind);
}

Result<void> validate_damping(const Damping& damping) {
  if (auto r = validate_not_negative("damping.stretch", damping.stretch); !r) return r;
  if (auto r = validate_not_negative("damping.bending", damping.bending); !r) return r;
  return validate_not_negative("damping.motion", damping.motion);
}

}  // namespace

Result<void> validate_wind(Vec3 wind) {
  if (finite(wind)) return {};
  return refuse("air.wind", "must be finite", text(wind));
}

Result<void> validate_material(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.bending.size(); ++i) {
    if (auto r = validate_bending(i, d.bending[i], d.positions.size()); !r) return r;
  }
  if (auto r = validate_damping(d.damping); !r) return r;
  return validate_air(d.air, d.positions.size());
}

}  // namespace weft
