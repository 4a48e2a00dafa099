/// Bytes as text of 64 letters, as RFC 4648 says, with padding.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace weft::tools {

std::string base64(std::string_view bytes);
/// Nothing if the text is no such text.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace weft::tools
