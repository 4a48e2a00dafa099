#include "tools/program/text/numbered_name.h"

#include <algorithm>

#include "tools/program/text/parse.h"

namespace weft::tools {

std::optional<NumberedName> NumberedName::of(std::string_view text) {
  constexpr int kWidest = 20;
  const std::size_t percent = text.rfind('%');
  if (percent == std::string_view::npos) return std::nullopt;
  const std::size_t end = text.find('d', percent);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view width = text.substr(percent + 1, end - percent - 1);
  const auto number = width.empty() ? 0 : parse_count(width);
  if (!number || *number > kWidest) return std::nullopt;
  NumberedName name;
  name.before_ = text.substr(0, percent);
  name.after_ = text.substr(end + 1);
  name.width_ = static_cast<int>(*number);
  name.fill_ = width.starts_with('0') ? '0' : ' ';
  return name;
}

std::string NumberedName::with(int number) const {
  const std::string digits = std::to_string(number);
  const auto missing =
      static_cast<std::size_t>(width_) - std::min(digits.size(), static_cast<std::size_t>(width_));
  return before_ + std::string(missing, fill_) + digits + after_;
}

}  // namespace weft::tools
