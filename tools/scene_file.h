/// Scenes as JSON files, read and written. A file mirrors weft::SceneDescription, and how its pins
/// move (pin_moves.h), in SI units:
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
///                     [0, 2, null, "rope"],       // likewise; kind "distance" (default) or "rope"
///                     [1, 3, 0.07, "rope", 1e-3]],  // a spring: its compliance, m/N
///     "bending": [{                               // optional; three or four of both
///       "particles":  [0, 1, 2],
///       "weights":    [1, -2, 1],
///       "rest":       0,                          // optional, this is the default
///       "compliance": 1e-3
///     }, ...],
///     "anchors": [{                               // optional; null: infinite
///       "particle": 7, "point": [x, y, z],
///       "max_distance": 0,                        // optional, this is the default
///       "normal": [0, 0, 1],                      // of the backstop; optional, none by default
///       "backstop_distance": 0.01, "backstop_radius": null
///     }, ...],
///     "damping": {"stretch": 1e-3, "bending": 1e-2, "motion": 0},  // optional, as each field is
///     "air": {                                    // optional, as each field is
///       "triangles": [[0, 1, 2], ...],
///       "density": 1.2, "drag": 0, "lift": 0, "wind": [0, 0, 0]
///     },
///     "spheres":     [400],                       // optional; particle numbers from 0
///     "radii":       [0, 0, ..., 0.15],           // with spheres: one per particle
///     "moves": [{                                 // optional
///       "particles":    [0, 1],                   // fixed; each in one entry at most
///       "times":        [0, 0.5],                 // s from the start, increasing
///       "translations": [[x, y, z], ...],         // one per time
///       "rotations":    [[x, y, z], ...],         // optional; rotation vectors, rad, one per time
///       "about":        [x, y, z],                // optional; what is turned about, else [0, 0,
///       0] "from":         [[x, y, z], ...]          // optional; one per particle: its place
///       without
///     }, ...]                                     // the motion, else that in "positions"
///   }
///
/// Between two times translations and rotation vectors are linear; before the first and after the
/// last pins stand still. Where the pose at time 0 differs from "positions" they are placed in it
/// before the first frame, and the cloth follows without becoming fast.
///
/// (Comments are not allowed in a real file.) Unknown keys are refused, and keys that are given
/// twice. An error names the place in the file, like "constraints[3][2]". Numbers survive writing
/// and reading again to the last bit.
#pragma once

#include <weft/weft.h>

#include <string>
#include <string_view>
#include <vector>

#include "tools/pin_moves.h"

namespace weft::tools {

struct SceneFile {
  SceneDescription description;
  std::vector<PinMove> moves;
};

Result<SceneFile> parse_scene(std::string_view text);
Result<SceneFile> read_scene_file(const std::string& path);

/// The file's text. One row of the arrays per line, so that files can be read and compared.
std::string scene_text(const SceneDescription& scene, const std::vector<PinMove>& moves = {});

/// The scene with the cloth's present positions and velocities, to be continued from there. With
/// moves: present_moves(), whose times begin anew and which say where their pins come "from".
SceneDescription present_scene(const SceneDescription& scene, const Cloth& cloth);

}  // namespace weft::tools
