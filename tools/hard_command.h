/// `weft hard`: the cases that break cloth engines.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::tools {

/// exit_code: 1 if a case fails, 2 if an output cannot be written or no case has the name given.
void add_hard_command(CLI::App& app, int& exit_code);

}  // namespace weft::tools
