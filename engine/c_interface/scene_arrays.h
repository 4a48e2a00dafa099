/// Scenes of C and of C++: the same, as one array a property and as lists of things.
#pragma once

#include <weft/scene.h>
#include <weft/weft_c.h>

#include <array>
#include <cstdint>
#include <vector>

namespace weft::c_interface {

weft_scene default_scene();
Result<SceneDescription> read_scene(const weft_scene* scene);

/// Arrays that a weft_scene points to, beside the lists of its SceneDescription.
struct SceneArrays {
  std::vector<std::array<std::uint32_t, 2>> constraint_particles;
  std::vector<double> rest_lengths;
  std::vector<std::uint8_t> constraint_kinds;
  std::vector<double> compliances;

  std::vector<std::array<std::uint32_t, 3>> membrane_particles;
  std::vector<std::array<std::array<double, 2>, 3>> membrane_rest;
  std::vector<std::array<double, 3>> membrane_stiffnesses;
  std::vector<std::uint8_t> membrane_kinds;

  std::vector<std::array<std::uint32_t, 4>> bending_particles;
  std::vector<std::array<double, 4>> bending_weights;
  std::vector<double> bending_rests;
  std::vector<double> bending_compliances;
  std::vector<double> bending_folds;

  std::vector<std::uint32_t> anchor_particles;
  std::vector<Vec3> anchor_points;
  std::vector<Vec3> anchor_normals;
  std::vector<double> anchor_max_distances;
  std::vector<double> backstop_distances;
  std::vector<double> backstop_radii;

  std::vector<std::array<std::uint32_t, 2>> seam_particles;
  std::vector<double> seam_times;
  std::vector<double> seam_max_forces;

  std::vector<weft_pressure> pressures;
};
SceneArrays arrays_of(const SceneDescription& scene);
/// Both must outlive it.
weft_scene scene_of(const SceneDescription& scene, const SceneArrays& arrays);

}  // namespace weft::c_interface
