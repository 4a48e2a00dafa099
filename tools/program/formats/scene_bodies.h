/// The key "bodies" of a scene file (scene_file.h).
#pragma once

#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/scenes/scene_body.h"

namespace weft::tools {

/// Throws Refused (json_reading.h). Files that bodies name are looked for from `folder`.
std::vector<SceneBody> read_bodies(const Json& json, const std::string& folder);
/// One entry of the array.
std::string body_row(const SceneBody& body);

}  // namespace weft::tools
