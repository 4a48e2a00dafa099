/// Numbers of C that stand for a choice.
#pragma once

#include <weft/result.h>

#include <string>
#include <string_view>

namespace weft::c_interface {

/// A choice of an enumeration whose last one is `last`.
template <class Choice>
Result<void> read_choice(std::string_view field, int number, Choice last, Choice& out) {
  if (number < 0 || number > static_cast<int>(last)) {
    return Error{std::string(field) + ": must be from 0 to " +
                 std::to_string(static_cast<int>(last)) + " (" + std::to_string(number) + ")"};
  }
  out = static_cast<Choice>(number);
  return {};
}

}  // namespace weft::c_interface
