/// Whole texts, in and out.
#pragma once

#include <weft/weft.h>

#include <string>
#include <string_view>

namespace weft::tools {

/// The whole file. An error names the path and says why.
Result<std::string> read_text_file(const std::string& path);

/// To standard output, with nothing left in a buffer. An error if it did not get there.
Result<void> print_text(std::string_view text);

}  // namespace weft::tools
