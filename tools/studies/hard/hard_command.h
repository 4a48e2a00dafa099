/// `weft hard`: the cases that break cloth engines.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 1 if a case fails, 2 if an output cannot be written or no case has the name given.
void add_hard_command(CommandLine& line);

}  // namespace weft::tools
