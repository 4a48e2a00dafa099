/// `weft replay FILE`: runs what `weft run --record` recorded, and names the first frame that
/// differs.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 1 if a frame differs, 2 if something given was refused.
void add_replay_command(CommandLine& line);

}  // namespace weft::tools
