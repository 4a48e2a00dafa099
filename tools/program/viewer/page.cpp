#include "tools/program/viewer/page.h"

#include <fmt/format.h>

#include "tools/program/files/text_file.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/viewer/base64.h"
#include "tools/program/viewer/motion.h"
#include "tools/program/viewer/page_template.h"

namespace weft::tools {
namespace {

constexpr std::string_view kPlace = "<!-- results -->";
constexpr std::string_view kBegin = "<script class=\"result\" type=\"application/octet-stream\">";
constexpr std::string_view kEnd = "</script>";

Error refused(const std::string& path, const std::string& why) {
  return {fmt::format("'{}': {}", path, why)};
}

Result<std::vector<std::string>> motions_of_page(const std::string& path, std::string_view page) {
  std::vector<std::string> motions;
  for (std::size_t at = page.find(kBegin); at != page.npos; at = page.find(kBegin, at)) {
    at += kBegin.size();
    const std::size_t end = page.find(kEnd, at);
    if (end == page.npos) return refused(path, "the page is cut off");
    auto bytes = bytes_of_base64(page.substr(at, end - at));
    if (!bytes) return refused(path, "the page is damaged");
    motions.push_back(std::move(*bytes));
  }
  if (motions.empty()) return refused(path, "the page is none that weft wrote");
  return motions;
}

}  // namespace

std::string page_of(std::span<const std::string> motions) {
  const std::string_view page = page_template();
  const std::size_t place = page.find(kPlace);
  std::string text(page.substr(0, place));
  for (const std::string& motion : motions) {
    text += kBegin;
    text += base64(motion);
    text += kEnd;
    text += '\n';
  }
  text += page.substr(place + kPlace.size());
  return text;
}

Result<std::vector<std::string>> read_motions(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  std::vector<std::string> motions{text.value()};
  if (file_ending(path) == ".html") {
    auto found = motions_of_page(path, text.value());
    if (!found) return found;
    motions = std::move(found).value();
  }
  for (const std::string& motion : motions) {
    if (auto checked = check_motion(motion); !checked) return refused(path, checked.error());
  }
  return motions;
}

}  // namespace weft::tools
