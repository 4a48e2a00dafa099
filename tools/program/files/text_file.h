/// Whole texts, in and out.
#pragma once

#include <weft/weft.h>

#include <string>
#include <string_view>

namespace weft::tools {

/// The whole file, or what a pipe has. An error names the path and says why. A device is refused:
/// it need not end.
Result<std::string> read_text_file(const std::string& path);

/// To standard output, with nothing left in a buffer. An error if it did not get there.
Result<void> print_text(std::string_view text);

/// To standard error. If it cannot be written nobody wants to know, and the program goes on.
void print_message(std::string_view text);

/// Descriptors of standard streams that are closed would be those of the next files that are
/// opened, and these would get what is printed. From here on they are open, but to no avail.
void hold_standard_streams();

}  // namespace weft::tools
