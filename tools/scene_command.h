/// `weft scene SCENE --out FILE.json`: writes a scene as JSON, to start one's own from.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::tools {

/// exit_code: 2 if something given was refused.
void add_scene_command(CLI::App& app, int& exit_code);

}  // namespace weft::tools
