/// Settings of C and of C++.
#pragma once

#include <weft/settings.h>
#include <weft/weft_c.h>

namespace weft::c_interface {

weft_settings settings_of(const Settings& settings);
/// Null: the defaults.
Result<Settings> read_settings(const weft_settings* settings);

}  // namespace weft::c_interface
