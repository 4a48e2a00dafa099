/// `weft run SCENE`: runs a scene and reports time beside error.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 2 if something given was refused, 3 if a step did not reach its tolerance.
void add_run_command(CommandLine& line);

}  // namespace weft::tools
