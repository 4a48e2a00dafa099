/// Names of files that are one of a series: "frame_%04d.obj".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace weft::tools {

class NumberedName {
 public:
  /// Nothing where the text has no %d, nor one with a width like %04d. The last one counts.
  static std::optional<NumberedName> of(std::string_view text);
  std::string with(int number) const;

 private:
  std::string before_, after_;
  int width_ = 0;
  char fill_ = ' ';
};

}  // namespace weft::tools
