/// The keys "moves" and "rest_scale" of a scene file (scene_file.h).
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/scenes/pin_moves.h"
#include "tools/scenes/rest_scale.h"

namespace weft::tools {

/// Throws Refused (json_reading.h). The scene is that of the file, all of it read.
std::vector<PinMove> read_moves(const Json& json, const SceneDescription& scene);

/// One entry of the array.
std::string move_row(const PinMove& move);

RestScale read_rest_scale(const Json& json);
std::string rest_scale_text(const RestScale& scale);

}  // namespace weft::tools
