/// `weft run SCENE`: runs a scene and reports time beside error.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::tools {

/// exit_code: 2 if something given was refused, 3 if a step did not reach its tolerance.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace weft::tools
