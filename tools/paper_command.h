/// `weft paper`: the measurements of the paper's section 5.
#pragma once

#include <CLI/CLI.hpp>

namespace weft::tools {

/// exit_code: 2 if an output cannot be written, 3 if a run did not reach its strain.
void add_paper_command(CLI::App& app, int& exit_code);

}  // namespace weft::tools
