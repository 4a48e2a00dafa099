/// Runs the scripts of tools/studies/plots, with a Python that has matplotlib.
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

namespace weft::tools {

/// script: a file name in tools/studies/plots. Waits for it to end; its own messages go to stderr.
Result<void> plot(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace weft::tools
