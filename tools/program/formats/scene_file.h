/// Scenes as JSON files, read and written: the particles of a scene, how its pins move
/// (pin_moves.h), what happens when (events.h), and the faces that pictures show.
/// tools/program/README.md describes the format.
///
/// Unknown keys are refused, and so are keys that are given twice. An error names the place in the
/// file, like "constraints[3][2]". Numbers survive writing and reading again to the last bit.
#pragma once

#include <weft/weft.h>

#include <string>
#include <string_view>
#include <vector>

#include "tools/scenes/events.h"
#include "tools/scenes/pin_moves.h"
#include "tools/scenes/rest_scale.h"
#include "tools/scenes/scene_body.h"

namespace weft::tools {

/// Faces are numbers of particles, in order around each.
using Faces = std::vector<std::vector<std::uint32_t>>;

struct SceneFile {
  SceneDescription description;
  std::vector<PinMove> moves;
  Faces faces;
  std::vector<SceneBody> bodies;
  std::vector<SceneEvent> events;
  RestScale rest_scale;
};

/// Files that the scene names are relative to `folder`.
Result<SceneFile> parse_scene(std::string_view text, const std::string& folder = {});
Result<SceneFile> read_scene_file(const std::string& path);

/// The file's text. One row of the arrays per line, so that files can be read and compared.
std::string scene_text(const SceneDescription& scene, const std::vector<PinMove>& moves = {},
                       const Faces& faces = {}, const std::vector<SceneBody>& bodies = {},
                       const std::vector<SceneEvent>& events = {},
                       const RestScale& rest_scale = {});

/// The scene with the cloth's present positions and velocities, torn as it is, to be continued from
/// there. Write it with present_moves() and present_events(): their times begin anew, "from" gives
/// the places of their pins, and what happened already is how the scene begins.
SceneDescription present_scene(const SceneDescription& scene, const Cloth& cloth);

}  // namespace weft::tools
