#include "tools/program/text/wrapping.h"

#include <fmt/format.h>

#include <algorithm>

namespace weft::tools {
namespace {

bool within_character(char byte) { return (byte & 0xc0) == 0x80; }  // of UTF-8

/// Bytes of the first `width` characters.
std::size_t bytes_of_width(std::string_view text, std::size_t width) {
  std::size_t end = 0;
  for (std::size_t characters = 0; end < text.size(); ++end) {
    if (within_character(text[end])) continue;
    if (characters++ == width) break;
  }
  return end;
}

bool ends_part(char byte) { return byte == ',' || byte == ';' || byte == ':'; }

/// Where the first line of the text ends: at a space, or at the end.
std::size_t end_of_line(std::string_view text, std::size_t width, Break where) {
  const std::size_t most = bytes_of_width(text, width);
  if (most == text.size()) return most;
  if (where == Break::at_commas) {
    for (std::size_t end = most; end > most / 2; --end) {
      if (text[end] == ' ' && ends_part(text[end - 1])) return end;
    }
  }
  const std::size_t space = text.rfind(' ', most);
  if (space != std::string_view::npos && space > 0) return space;
  return std::min(text.find(' ', most), text.size());
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t indent, Break where) {
  std::string lines;
  while (true) {
    const std::size_t end = end_of_line(text, kLineWidth - indent, where);
    lines += text.substr(0, end);
    if (end == text.size()) return lines;
    text.remove_prefix(end + 1);
    lines += fmt::format("\n{:{}}", "", indent);
  }
}

std::string in_columns(std::string_view name, std::string_view meaning, std::size_t column) {
  const bool fits = name.size() + 1 < column;
  const std::string first =
      fits ? fmt::format("{:<{}}", name, column) : fmt::format("{}\n{:{}}", name, "", column);
  return first + wrapped(meaning, column) + "\n";
}

}  // namespace weft::tools
