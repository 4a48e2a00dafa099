#include <cmath>
#include <vector>

#include "engine/hypotenuse.h"
#include "engine/model/model.h"
#include "engine/model/validate.h"
#include "engine/validation.h"

namespace weft {
namespace {

Result<void> validate_normal(const std::string& field, Vec3 normal) {
  if (!finite(normal)) return refuse(field, "must be finite", text(normal));
  const double length = hypotenuse(normal.x, normal.y, normal.z);
  if (length > 0 && std::isfinite(length)) return {};
  return refuse(field, "must have a length", text(normal));
}

Result<void> validate_distance(const std::string& field, double value) {
  if (value >= 0) return {};
  return refuse(field, "must be at least 0, or infinite", number(value));
}

Result<void> validate_anchor(const std::string& field, const Anchor& anchor) {
  if (!finite(anchor.point)) return refuse(field + ".point", "must be finite", text(anchor.point));
  if (auto r = validate_distance(field + ".max_distance", anchor.max_distance); !r) return r;
  if (auto r = validate_not_negative(field + ".backstop_distance", anchor.backstop_distance); !r)
    return r;
  if (auto r = validate_distance(field + ".backstop_radius", anchor.backstop_radius); !r) return r;
  if (anchor.backstop_radius == 0) return {};
  if (anchor.backstop_radius < kLeastSquared) {
    return refuse(field + ".backstop_radius", "must be 0 or at least 1e-150, to be squared",
                  number(anchor.backstop_radius));
  }
  return validate_normal(field + ".normal", anchor.normal);
}

}  // namespace

Result<void> validate_anchors(const SceneDescription& d) {
  std::vector<bool> taken(d.anchors.empty() ? 0 : d.positions.size());
  std::vector<bool> fixed(taken.size());
  for (const std::uint32_t particle : d.fixed) {
    if (!fixed.empty()) fixed[particle] = true;
  }
  for (std::size_t i = 0; i < d.anchors.size(); ++i) {
    const std::string field = element("anchors", i);
    const std::uint32_t particle = d.anchors[i].particle;
    if (auto r = validate_particle(field + ".particle", particle, d.positions.size()); !r) return r;
    if (fixed[particle])
      return refuse(field + ".particle", "is a fixed particle", std::to_string(particle));
    if (taken[particle])
      return refuse(field + ".particle", "has an anchor already", std::to_string(particle));
    taken[particle] = true;
    if (auto r = validate_anchor(field, d.anchors[i]); !r) return r;
  }
  return {};
}

Result<void> validate_anchor_limits(const Model& model, std::span<const AnchorLimit> limits) {
  if (auto r = validate_size("limits", limits.size(), model.anchors.size()); !r) return r;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string field = element("limits", i) + ".max_distance";
    if (auto r = validate_distance(field, limits[i].max_distance); !r) return r;
  }
  return {};
}

Result<void> validate_anchor_limit(const Model& model, std::uint32_t anchor,
                                   const AnchorLimit& limit) {
  if (anchor >= model.anchors.size()) {
    return refuse("anchor", "no such anchor, the scene has " + std::to_string(model.anchors.size()),
                  std::to_string(anchor));
  }
  return validate_distance("limit.max_distance", limit.max_distance);
}

Result<void> validate_anchor_move(const Model& model, std::span<const Vec3> points,
                                  std::span<const Vec3> normals) {
  const std::size_t count = model.anchors.size();
  if (auto r = validate_vectors("points", points, count); !r) return r;
  if (normals.empty()) return {};
  if (auto r = validate_vectors("normals", normals, count); !r) return r;
  for (std::size_t i = 0; i < count; ++i) {
    if (!model.anchors.limits[i].has_backstop) continue;
    if (auto r = validate_normal(element("normals", i), normals[i]); !r) return r;
  }
  return {};
}

}  // namespace weft
