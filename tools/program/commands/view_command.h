/// `weft view RESULT [RESULT] --out FILE.html`: a page that shows what runs left in --out, one or
/// two side by side.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 2 if something given was refused.
void add_view_command(CommandLine& line);

}  // namespace weft::tools
