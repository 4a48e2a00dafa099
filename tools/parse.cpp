#include "tools/parse.h"

#include <array>
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

Result<double> parse_tolerance(std::string_view option, std::string_view text) {
  const bool percent = text.ends_with('%');
  const auto number = parse_number(percent ? text.substr(0, text.size() - 1) : text);
  if (!number || *number <= 0) {
    return Error{fmt::format("{}: '{}' is not a strain above 0, like 1% or 0.01", option, text)};
  }
  return percent ? *number / 100 : *number;
}

Result<Vec3> parse_vector(std::string_view option, std::string_view text) {
  std::array<double, 3> values{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    const auto value = parse_number(rest.substr(0, comma));
    if (!value || (comma == std::string_view::npos) != (i == 2)) {
      return Error{fmt::format("{}: '{}' is not x,y,z", option, text)};
    }
    values[i] = *value;
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  return Vec3{values[0], values[1], values[2]};
}

Result<bool> parse_switch(std::string_view option, std::string_view text) {
  if (text == "on") return true;
  if (text == "off") return false;
  return Error{fmt::format("{}: '{}' is not one of on, off", option, text)};
}

}  // namespace weft::tools
