/// `weft completion`: a script by which bash completes the command line.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Of all verbs that the line has when the command runs.
void add_completion_command(CommandLine& line);

}  // namespace weft::tools
