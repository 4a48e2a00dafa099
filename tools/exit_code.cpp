#include "tools/exit_code.h"

#include <fmt/format.h>

#include <cstdio>

namespace weft::tools {

int refuse(std::string_view message) {
  fmt::print(stderr, "weft: {}\n", message);
  return kRefused;
}

}  // namespace weft::tools
