/// The page without its results: tools/viewer/page.html, which CMake puts into the program.
#pragma once

#include <string_view>

namespace weft::tools {

std::string_view page_template();

}  // namespace weft::tools
