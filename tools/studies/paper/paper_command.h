/// `weft paper`: the measurements of the paper's section 5.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: 2 if an output cannot be written, 3 if a run did not reach its strain.
void add_paper_command(CommandLine& line);

}  // namespace weft::tools
