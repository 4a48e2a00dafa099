/// Scenes as JSON files, read and written. A file mirrors weft::SceneDescription, in SI units:
///
///   {
///     "gravity":     [0, -10, 0],                 // optional, this is the default
///     "positions":   [[x, y, z], ...],            // one per particle
///     "velocities":  [[x, y, z], ...],            // optional; one per particle
///     "masses":      [m, ...],                    // one per particle, or instead of it
///     "total_mass":  1,                           // shared equally by all particles
///     "fixed":       [0, 1],                      // optional; particle numbers from 0
///     "constraints": [[0, 1, 0.05],               // particles a, b, rest length
///                     [1, 2],                     // rest length measured from the positions
///                     [0, 2, null, "rope"]],      // likewise; kind "distance" (default) or "rope"
///     "spheres":     [400],                       // optional; particle numbers from 0
///     "radii":       [0, 0, ..., 0.15]            // with spheres: one per particle
///   }
///
/// (Comments are not allowed in a real file.) Unknown keys are refused, and keys that are given
/// twice. An error names the place in the file, like "constraints[3][2]". Numbers survive writing
/// and reading again to the last bit.
#pragma once

#include <weft/weft.h>

#include <string>
#include <string_view>

#include "tools/json_output.h"

namespace weft::tools {

Result<SceneDescription> parse_scene(std::string_view text);
Result<SceneDescription> read_scene_file(const std::string& path);

/// The file's text. One row of the arrays per line, so that files can be read and compared.
std::string scene_text(const SceneDescription& scene);

/// The scene with the cloth's present positions and velocities, to be continued from there.
SceneDescription present_scene(const SceneDescription& scene, const Cloth& cloth);

}  // namespace weft::tools
