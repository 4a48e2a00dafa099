#include "tools/program/terminal/exit_code.h"

#include <fmt/format.h>

#include "tools/program/files/text_file.h"
#include "tools/program/text/wording.h"

namespace weft::tools {

int refuse(std::string_view message) {
  print_message(fmt::format("weft: {}\n", in_one_line(std::string(message))));
  return kRefused;
}

int missed_tolerance(std::string_view where) {
  print_message(fmt::format("weft: the tolerance was missed, first in {}\n", where));
  return kMissedTolerance;
}

}  // namespace weft::tools
