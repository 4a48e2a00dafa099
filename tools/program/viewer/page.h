/// Pages that show motions (motion.h) in a browser, and open from a disk without a server.
#pragma once

#include <weft/weft.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::tools {

/// Two are shown side by side.
inline constexpr std::size_t kMostMotions = 2;

/// The motions are bytes of files. They stand in the page as base64, each in a script of its own
/// whose type is none that runs.
std::string page_of(std::span<const std::string> motions);

/// The motions of a file that is one, or of a page. An error names the file.
Result<std::vector<std::string>> read_motions(const std::string& path);

}  // namespace weft::tools
