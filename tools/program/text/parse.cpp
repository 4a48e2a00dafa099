#include "tools/program/text/parse.h"

#include <charconv>
#include <cmath>

namespace weft::tools {
namespace {

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, number);
  if (failure != std::errc{} || stop != end) return std::nullopt;
  return number;
}

/// The parts between commas, each read; nothing if one of them cannot be read.
template <class Value, class Read>
std::optional<std::vector<Value>> parse_list(std::string_view text, Read read) {
  std::vector<Value> values;
  for (;;) {
    const std::size_t comma = text.find(',');
    const std::optional<Value> value = read(text.substr(0, comma));
    if (!value) return std::nullopt;
    values.push_back(*value);
    if (comma == std::string_view::npos) return values;
    text.remove_prefix(comma + 1);
  }
}

/// "7" or "7-9".
std::optional<NumberRange> parse_range(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto first = parse_count(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : parse_count(text.substr(dash + 1));
  if (!first || !last) return std::nullopt;
  return NumberRange{*first, *last};
}

std::string_view without_plus(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return text;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto number = parse_whole<double>(without_plus(text));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<int> parse_integer(std::string_view text) {
  return parse_whole<int>(without_plus(text));
}

std::optional<long long> parse_count(std::string_view text) {
  const auto count = parse_whole<long long>(text);
  return count && *count >= 0 ? count : std::nullopt;
}

std::optional<std::vector<NumberRange>> parse_ranges(std::string_view text) {
  return parse_list<NumberRange>(text, parse_range);
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  return parse_list<double>(text, parse_number);
}

Result<double> parse_seconds(std::string_view option, std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto dividend = parse_number(text.substr(0, slash));
  const auto divisor = slash == std::string_view::npos ? 1.0 : parse_number(text.substr(slash + 1));
  const double seconds = dividend && divisor ? *dividend / *divisor : 0;
  if (seconds > 0 && std::isfinite(seconds)) return seconds;
  return Error{fmt::format("{}: '{}' is not a time above 0, like 0.01 or 1/60", option, text)};
}

Result<double> parse_tolerance(std::string_view option, std::string_view text) {
  const bool percent = text.ends_with('%');
  const auto number = parse_number(percent ? text.substr(0, text.size() - 1) : text);
  if (!number || *number <= 0) {
    return Error{fmt::format("{}: '{}' is not a strain above 0, like 1% or 0.01", option, text)};
  }
  return percent ? *number / 100 : *number;
}

Result<Vec3> parse_vector(std::string_view option, std::string_view text) {
  const auto numbers = parse_numbers(text);
  if (numbers && numbers->size() == 3) return Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return Error{fmt::format("{}: '{}' is not x,y,z", option, text)};
}

Result<bool> parse_switch(std::string_view option, std::string_view text) {
  if (text == "on") return true;
  if (text == "off") return false;
  return Error{fmt::format("{}: '{}' is not one of on, off", option, text)};
}

}  // namespace weft::tools
