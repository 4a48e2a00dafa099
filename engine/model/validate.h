/// Refused input, in one line of the form "field[index]: reason (value)".
#pragma once

#include <weft/scene_fields.h>
#include <weft/weft.h>

#include <string_view>

namespace weft {

class FieldName;
class Model;

Result<void> validate(const SceneDescription& description);
Result<void> validate(const Changes& changes, const Model& model);
/// Checks all lists of elements, and values of the scene itself.
Result<void> validate_elements(const SceneDescription& description);
/// Checks a description, except its particles, elements and spheres.
Result<void> validate_material(const SceneDescription& description);
Result<void> validate_damping(const Damping& damping);
Result<void> validate_number(Values values, const FieldName& field, double value);
/// Particles of the scene, and no two alike.
Result<void> validate_corners(const FieldName& field, std::span<const std::uint32_t> corners,
                              std::size_t particles);
/// Checks the normal of a backstop.
Result<void> validate_normal(const FieldName& field, Vec3 normal);
/// Checks the places of all anchors; normals: or none.
Result<void> validate_anchor_move(const Model& model, std::span<const Vec3> points,
                                  std::span<const Vec3> normals);
Result<void> validate_anchor_limits(const Model& model, std::span<const AnchorLimit> limits);
Result<void> validate_anchor_limit(const Model& model, std::uint32_t anchor,
                                   const AnchorLimit& limit);
/// Checks numbers of seams.
Result<void> validate_seams(const Model& model, std::span<const std::uint32_t> seams);
Result<void> validate_gravity(Vec3 gravity);
Result<void> validate_wind(Vec3 wind);
Result<void> validate_air(const ChangedAir& air, bool has_triangles);
Result<void> validate_motion(const RigidMotion& motion, double share);
Result<void> validate_time_step(double dt);
/// One finite vector per particle.
Result<void> validate_vectors(std::string_view field, std::span<const Vec3> vectors,
                              std::size_t particles);
Result<void> validate_vector(std::string_view field, std::size_t index, Vec3 vector);
Result<void> validate_size(std::string_view field, std::size_t size, std::size_t expected);
Result<void> validate_floats(std::string_view field, const FloatVectors& floats,
                             std::size_t expected);
/// Checks the point that floats are relative to.
Result<void> validate_origin(Vec3 origin);

}  // namespace weft
