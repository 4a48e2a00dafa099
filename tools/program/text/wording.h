/// Numbers as all tables and messages word them.
#pragma once

#include <fmt/format.h>
#include <weft/weft.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "engine/validation.h"

namespace weft::tools {

/// As much of a text from outside as a message shows: its beginning, in one line.
inline std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::size_t end = std::min(kMost, text.size());
  const auto within_character = [](char byte) { return (byte & 0xc0) == 0x80; };  // of UTF-8
  while (end < text.size() && end > 0 && within_character(text[end])) --end;
  const std::string line = in_one_line(std::string(text.substr(0, end)));
  return end < text.size() ? line + "..." : line;
}

/// What was asked for, as it was asked: 0.001 %.
inline std::string percent(double fraction) { return fmt::format("{:g} %", 100 * fraction); }

/// What was measured, to three digits: 0.0886 %.
inline std::string measured_percent(double fraction) {
  return fmt::format("{:.3g} %", 100 * fraction);
}

/// How many times as much, to three digits: 9.84, 2083.
inline std::string factor_text(double factor) {
  return fmt::format(fmt::runtime(factor < 1000 ? "{:.3g}" : "{:.0f}"), factor);
}

/// "1 sphere", "0 spheres"; for nouns whose plural has no more than an s.
template <class Number>
std::string counted(Number count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

inline std::string substeps_text(int substeps) {
  return substeps == kAutomaticSubsteps ? "automatic substeps" : counted(substeps, "substep");
}

}  // namespace weft::tools
