/// `weft precision`: error against time per frame.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::tools {

/// exit_code: 2 if something given was refused or an output cannot be written. Settings that miss
/// their tolerance are part of the result, and no failure of the command.
void add_precision_command(CLI::App& app, int& exit_code);

}  // namespace weft::tools
