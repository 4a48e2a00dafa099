/// Scenes of C and of C++: the same, as one array a property and as lists of elements.
#pragma once

#include <weft/scene.h>
#include <weft/weft_c.h>

#include <cstdint>
#include <tuple>
#include <vector>

namespace weft::c_interface {

weft_scene default_scene();
Result<SceneDescription> read_scene(const weft_scene* scene);

/// A weft_scene of a SceneDescription points to these arrays, and to lists of the description. They
/// hold its elements, in the order of their fields (weft/scene_fields.h).
struct SceneArrays {
  std::tuple<std::vector<std::vector<double>>, std::vector<std::vector<std::uint32_t>>,
             std::vector<std::vector<std::uint8_t>>>
      elements;
  std::vector<weft_pressure> pressures;
};
SceneArrays arrays_of(const SceneDescription& scene);
/// Both must outlive it.
weft_scene scene_of(const SceneDescription& scene, const SceneArrays& arrays);

}  // namespace weft::c_interface
