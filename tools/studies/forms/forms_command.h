/// `weft forms`: closed forms and what is measured, in one table.
#pragma once

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

/// Exit code: kCaseFailed if one does not hold; 2 if something given was refused or an output
/// cannot be written.
void add_forms_command(CommandLine& line);

}  // namespace weft::tools
