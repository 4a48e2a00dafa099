/// Long lines in several, as wide as a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft::tools {

inline constexpr std::size_t kLineWidth = 80;

enum class Break {
  at_spaces,
  at_commas
};  ///< at_commas: at spaces where no comma comes late enough

/// A text that begins in the column `indent`, with line breaks and so many spaces after each. Words
/// that are longer than a line stay whole.
std::string wrapped(std::string_view text, std::size_t indent, Break where = Break::at_spaces);

/// `name` and what it means, in two columns; in two lines where the name reaches the second column.
std::string in_columns(std::string_view name, std::string_view meaning, std::size_t column);

}  // namespace weft::tools
