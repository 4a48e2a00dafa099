/// The key "events" of a scene file (scene_file.h).
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/scenes/events.h"

namespace weft::tools {

/// Throws Refused (json_reading.h). The scene is that of the file, all of it read.
std::vector<SceneEvent> read_events(const Json& json, const SceneDescription& scene);

/// One entry of the array.
std::string event_row(const SceneEvent& event);

}  // namespace weft::tools
