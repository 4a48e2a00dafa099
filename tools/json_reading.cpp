#include "tools/json_reading.h"

#include <algorithm>

namespace weft::tools {
namespace {

std::string shortened(std::string text) {
  constexpr std::size_t kMost = 40;
  if (text.size() <= kMost) return text;
  const auto within_character = [](char byte) { return (byte & 0xc0) == 0x80; };  // of UTF-8
  std::size_t end = kMost;
  while (within_character(text[end])) --end;
  return text.substr(0, end) + "...";
}

/// Without what nests in it, which may be as deep as the file is long.
std::string brief(const Json& found) {
  if (std::ranges::none_of(found, [](const Json& part) { return part.is_structured(); })) {
    return shortened(found.dump());
  }
  return found.is_array() ? "a nested array" : "a nested object";
}

}  // namespace

std::string in_quotes(const Json& key) {
  const std::string text = key.dump();
  return '\'' + shortened(text.substr(1, text.size() - 2)) + '\'';
}

void refuse(const std::string& place, std::string_view expected, const Json& found) {
  throw Refused{fmt::format("{}: expected {}, not {}", place, expected, brief(found))};
}

std::string plain_message(const Json::exception& exception) {
  const std::string_view text = exception.what();
  const std::size_t bracket = text.find("] ");
  return std::string(bracket == std::string_view::npos ? text : text.substr(bracket + 2));
}

double read_number(const Json& json, const std::string& place) {
  if (!json.is_number()) refuse(place, "a number", json);
  return json.get<double>();
}

std::uint32_t read_index(const Json& json, const std::string& place) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() >= kNoIndex) {
    refuse(place, "a particle number", json);
  }
  return json.get<std::uint32_t>();
}

Vec3 read_vector(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 3) refuse(place, "[x, y, z]", json);
  const auto component = [&](std::size_t i) {
    return read_number(json[i], fmt::format("{}[{}]", place, i));
  };
  return {component(0), component(1), component(2)};
}

}  // namespace weft::tools
