/// The enumerators of the enums that weft.h names.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

namespace weft::tools {

/// All of them: an enum ends where name() knows no more.
template <class Enum>
std::vector<Enum> enumerators() {
  std::vector<Enum> all;
  for (std::uint8_t i = 0; name(static_cast<Enum>(i)) != "unknown"; ++i) {
    all.push_back(static_cast<Enum>(i));
  }
  return all;
}

}  // namespace weft::tools
