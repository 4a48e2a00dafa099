/// Values of options, from text. An error names the option and the value that was refused.
#pragma once

#include <weft/weft.h>

#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>

#include "tools/enumerators.h"

namespace weft::tools {

/// The whole text as a finite number, with a sign or without; nothing if it is anything else.
std::optional<double> parse_number(std::string_view text);
/// The whole text as a whole number, in decimal digits with a sign or without; nothing if it is
/// anything else, or more than an int holds.
std::optional<int> parse_integer(std::string_view text);
/// The whole text as a whole number from 0 up; nothing if it is anything else.
std::optional<long long> parse_count(std::string_view text);

/// A strain above 0: "1%" or "0.01".
Result<double> parse_tolerance(std::string_view option, std::string_view text);
/// "x,y,z": three finite numbers.
Result<Vec3> parse_vector(std::string_view option, std::string_view text);
/// "on" or "off".
Result<bool> parse_switch(std::string_view option, std::string_view text);

/// The enumerator of this name.
template <class Enum>
Result<Enum> parse_choice(std::string_view option, std::string_view text) {
  std::string names;
  for (const Enum choice : enumerators<Enum>()) {
    if (name(choice) == text) return choice;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name(choice));
  }
  return Error{fmt::format("{}: '{}' is not one of {}", option, text, names)};
}

}  // namespace weft::tools
