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

/// Visits values, and keeps nothing but where the parser came to an error.
class ErrorFinder final : public nlohmann::json_sax<Json> {
 public:
  std::size_t bytes_read() const { return bytes_read_; }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t position, const std::string&, const Json::exception&) override {
    bytes_read_ = position;
    return false;
  }

 private:
  std::size_t bytes_read_ = 0;
};

std::string line_of_error(std::string_view text) {
  ErrorFinder finder;
  Json::sax_parse(text, &finder);
  const std::string_view read = text.substr(0, finder.bytes_read());
  return fmt::format("line {}", 1 + std::ranges::count(read, '\n'));
}

}  // namespace

std::string in_quotes(const Json& key) {
  const std::string text = key.dump();
  return '\'' + shown(text.substr(1, text.size() - 2)) + '\'';
}

void refuse(const std::string& place, std::string_view expected, const Json& found) {
  throw Refused{fmt::format("{}: expected {}, not {}", place, expected, brief(found))};
}

std::string plain_message(const Json::exception& exception, std::string_view text) {
  const std::string_view message = exception.what();
  const std::size_t bracket = message.find("] ");
  const std::string plain = with_short_quote(
      std::string(bracket == std::string_view::npos ? message : message.substr(bracket + 2)));
  const bool is_out_of_range = dynamic_cast<const Json::out_of_range*>(&exception) != nullptr;
  return is_out_of_range ? fmt::format("{}: {}", line_of_error(text), plain) : plain;
}

void check_keys(const Json& json, const std::string& place, const Keys& known, const Keys& needed) {
  if (!json.is_object()) refuse(place, "an object", json);
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, std::string_view(key)) != known.end()) continue;
    throw Refused{fmt::format("{}: unknown key {}", place, in_quotes(key))};
  }
  for (const std::string_view key : needed) {
    if (json.contains(key)) continue;
    throw Refused{fmt::format("{}: the key '{}' is missing", place, key)};
  }
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
