#include "tools/exit_code.h"

#include <fmt/format.h>

#include <cstdio>

namespace weft::tools {

int refuse(std::string_view message) {
  fmt::print(stderr, "weft: {}\n", message);
  return kRefused;
}

int missed_tolerance(std::string_view where) {
  fmt::print(stderr, "weft: the tolerance was missed, first in {}\n", where);
  return kMissedTolerance;
}

}  // namespace weft::tools
