/// `weft precision`: error against time per frame.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 2 if something given was refused or an output cannot be written. Settings that miss
/// their tolerance are part of the result, and no failure of the command.
void add_precision_command(CommandLine& line);

}  // namespace weft::tools
