/// Values of options, from text. An error names the option and the value that was refused.
#pragma once

#include <weft/weft.h>

#include <fmt/format.h>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace weft::tools {

/// The whole text as a finite number; nothing if it is anything else.
std::optional<double> parse_number(std::string_view text);
/// The whole text as a whole number from 0 up; nothing if it is anything else.
std::optional<long long> parse_count(std::string_view text);

/// A strain above 0: "1%" or "0.01".
Result<double> parse_tolerance(std::string_view option, std::string_view text);
/// "on" or "off".
Result<bool> parse_switch(std::string_view option, std::string_view text);

/// A name that an option accepts.
template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

/// The value of a name, looked up in the option's table.
template <class Value>
Result<Value> parse_choice(std::string_view option, std::string_view text,
                           std::span<const Choice<Value>> table) {
  std::string names;
  for (const Choice<Value>& choice : table) {
    if (choice.name == text) return choice.value;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", choice.name);
  }
  return Error{fmt::format("{}: '{}' is not one of {}", option, text, names)};
}

}  // namespace weft::tools
