/// Settings as JSON: all fields, by their names.
#pragma once

#include <weft/weft.h>

#include <string>

#include "tools/program/files/json_output.h"

namespace weft::tools {

Json settings_json(const Settings& settings);
/// `place` begins the names in errors. Throws Refused (json_reading.h) where a field is missing,
/// is not what it must be, or is none of Settings.
Settings read_settings(const Json& json, const std::string& place);

}  // namespace weft::tools
