/// The folder of --out, for verbs that write several files.
#pragma once

#include <weft/weft.h>

#include <filesystem>
#include <string>

namespace weft::tools {

/// Makes the folder if need be. A folder that cannot be written is refused now, not after the work.
Result<void> make_output_folder(const std::string& folder);

/// The file appears under its name only when it is complete.
Result<void> write_file(const std::filesystem::path& path, const std::string& content);

}  // namespace weft::tools
