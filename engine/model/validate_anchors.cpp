#include <cmath>

#include "engine/hypotenuse.h"
#include "engine/model/model.h"
#include "engine/model/validate.h"
#include "engine/validation.h"

namespace weft {

Result<void> validate_normal(const FieldName& field, Vec3 normal) {
  if (!finite(normal)) return refuse(field, "must be finite", text(normal));
  const double length = hypotenuse(normal.x, normal.y, normal.z);
  if (length > 0 && std::isfinite(length)) return {};
  return refuse(field, "must have a length", text(normal));
}

Result<void> validate_anchor_limits(const Model& model, std::span<const AnchorLimit> limits) {
  if (auto r = validate_size("limits", limits.size(), model.anchors.described.size()); !r) return r;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string field = element("limits", i) + ".max_distance";
    if (auto r = validate_number(Values::not_negative_or_infinite, field, limits[i].max_distance);
        !r)
      return r;
  }
  return {};
}

Result<void> validate_anchor_limit(const Model& model, std::uint32_t anchor,
                                   const AnchorLimit& limit) {
  const std::size_t count = model.anchors.described.size();
  if (anchor >= count) {
    return refuse("anchor", "no such anchor, the scene has " + std::to_string(count),
                  std::to_string(anchor));
  }
  return validate_number(Values::not_negative_or_infinite, "limit.max_distance",
                         limit.max_distance);
}

Result<void> validate_seams(const Model& model, std::span<const std::uint32_t> seams) {
  for (std::size_t i = 0; i < seams.size(); ++i) {
    if (seams[i] < model.seams.size()) continue;
    return refuse(element("seams", i),
                  "no such seam, the scene has " + std::to_string(model.seams.size()),
                  std::to_string(seams[i]));
  }
  return {};
}

Result<void> validate_anchor_move(const Model& model, std::span<const Vec3> points,
                                  std::span<const Vec3> normals) {
  const std::size_t count = model.anchors.described.size();
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
