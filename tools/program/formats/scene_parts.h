/// Parts of a scene in a scene file: its elements, such as constraints, anchors and seams, and what
/// it says of damping, air, pressures and the like (weft/scene_fields.h).
#pragma once

#include <fmt/format.h>
#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/files/json_output.h"

namespace weft::tools {

/// Reads the part with this name; false: there is none. Throws Refused (json_reading.h). A
/// constraint without a rest length gets the distance of its particles later: until then the length
/// is kMeasured, which is no legal one. A cloth with "self_contact" touches itself, unless "on" is
/// false there.
bool read_part(const std::string& key, const Json& json, SceneDescription& scene);
inline constexpr double kMeasured = 0;

std::array<std::uint32_t, 3> read_triangle(const Json& json, const std::string& place);

/// A list with this key, a line each value.
template <class Value, class Row>
void add_rows(std::string& text, std::string_view key, const std::vector<Value>& values, Row row) {
  if (values.empty()) return;
  text += fmt::format(",\n\"{}\": [", key);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i == 0 ? "\n" : ",\n";
    text += row(values[i]);
  }
  text += "\n]";
}
/// All parts that are not as a description has them by itself.
std::string parts_text(const SceneDescription& scene);

}  // namespace weft::tools
