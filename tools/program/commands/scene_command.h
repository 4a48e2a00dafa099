/// `weft scene SCENE --out FILE.json`: writes a scene as JSON, to start one's own from.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 2 if something given was refused.
void add_scene_command(CommandLine& line);

}  // namespace weft::tools
