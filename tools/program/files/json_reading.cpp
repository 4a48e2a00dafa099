#include "tools/program/files/json_reading.h"

#include <algorithm>

#include "tools/program/text/wording.h"

namespace weft::tools {
namespace {

/// Without what nests in it, which may be as deep as the file is long.
std::string brief(const Json& found) {
  if (std::ranges::none_of(found, [](const Json& part) { return part.is_structured(); })) {
    return shown(found.dump());
  }
  return found.is_array() ? "a nested array" : "a nested object";
}

/// The parser quotes what it read last, however long that is, and may say then what it expected.
/// The quoted text may contain these words, too.
std::string with_short_quote(std::string message) {
  constexpr std::string_view kBefore = "last read: '", kAfter = "'; expected ";
  constexpr std::size_t kLongestExpectation = 64;
  const std::size_t found = message.find(kBefore);
  if (found == std::string::npos) return message;
  const std::size_t begin = found + kBefore.size();
  const std::size_t after = message.rfind(kAfter);
  const bool says_more =
      after != std::string::npos && message.size() - after <= kLongestExpectation;
  const std::size_t end = says_more ? after : message.rfind('\'');
  if (end == std::string::npos || end < begin) return message;
  return message.replace(begin, end - begin, shown(message.substr(begin, end - begin)));
}

}  // namespace

std::string in_quotes(const Json& key) {
  const std::string text = key.dump();
  return '\'' + shown(text.substr(1, text.size() - 2)) + '\'';
}

void refuse(const std::string& place, std::string_view expected, const Json& found) {
  throw Refused{fmt::format("{}: expected {}, not {}", place, expected, brief(found))};
}

std::string plain_message(const Json::exception& exception) {
  const std::string_view text = exception.what();
  const std::size_t bracket = text.find("] ");
  return with_short_quote(
      std::string(bracket == std::string_view::npos ? text : text.substr(bracket + 2)));
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
