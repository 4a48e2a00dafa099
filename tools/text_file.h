#pragma once

#include <weft/weft.h>

#include <string>

namespace weft::tools {

/// The whole file. An error names the path and says why.
Result<std::string> read_text_file(const std::string& path);

}  // namespace weft::tools
