/// Reading JSON that others wrote. Every function takes the value and its place in the file, like
/// "constraints[3][2]", and throws Refused, one line that names the place, where the value is not
/// what it must be. (The only errors here that are thrown: a file nests, and its errors end
/// everything.)
#pragma once

#include <fmt/format.h>
#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/files/json_output.h"

namespace weft::tools {

struct Refused {
  std::string message;
};

/// Of a key, in one line, whatever it has in it.
std::string in_quotes(const Json& key);

/// A place in an object: "moves[0].times".
inline std::string within(const std::string& place, std::string_view key) {
  return fmt::format("{}.{}", place, key);
}
/// "place: expected ..., not ..."
[[noreturn]] void refuse(const std::string& place, std::string_view expected, const Json& found);

/// "[json.exception.parse_error.101] parse error at line 2, ..." without the brackets; with the
/// line of `text` where it is not in there.
std::string plain_message(const Json::exception& exception, std::string_view text);

using Keys = std::vector<std::string_view>;
/// An object that has no keys but known ones, and the needed ones.
void check_keys(const Json& json, const std::string& place, const Keys& known, const Keys& needed);

double read_number(const Json& json, const std::string& place);
std::uint32_t read_index(const Json& json, const std::string& place);  // of a particle
Vec3 read_vector(const Json& json, const std::string& place);

template <class Read>
auto read_array(const Json& json, const std::string& place, Read read) {
  if (!json.is_array()) refuse(place, "an array", json);
  std::vector<decltype(read(json, place))> values;
  values.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    values.push_back(read(json[i], fmt::format("{}[{}]", place, i)));
  }
  return values;
}

}  // namespace weft::tools
