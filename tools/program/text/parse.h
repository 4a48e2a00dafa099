/// Values of options, from text. An error names the option and the value that was refused.
#pragma once

#include <weft/weft.h>

#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/text/enumerators.h"

namespace weft::tools {

/// The whole text as a finite number, with a sign or without; nothing if it is anything else.
std::optional<double> parse_number(std::string_view text);
/// The whole text as a whole number, in decimal digits with a sign or without; nothing if it is
/// anything else, or more than an int holds.
std::optional<int> parse_integer(std::string_view text);
/// The whole text as a whole number from 0 up; nothing if it is anything else.
std::optional<long long> parse_count(std::string_view text);

/// Whole numbers from first to last; last may be the smaller one.
struct NumberRange {
  long long first = 0, last = 0;
  long long count() const { return (last < first ? first - last : last - first) + 1; }
  long long at(long long i) const { return last < first ? first - i : first + i; }
};
/// "0,5,7-9": from 0 up; nothing if it is anything else.
std::optional<std::vector<NumberRange>> parse_ranges(std::string_view text);

/// "1.5,0,-2": finite numbers; nothing if it is anything else.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// A time above 0, in s: "0.01" or "1/60".
Result<double> parse_seconds(std::string_view option, std::string_view text);
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
