/// `weft scenes`: the scenes that are built in, a line each.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

void add_scenes_command(CommandLine& line);

}  // namespace weft::tools
