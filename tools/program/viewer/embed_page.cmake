# cmake -DPAGE=page.html -DSOURCE=page_template.cpp -P embed_page.cmake: the page as a string of C++.
# Strings of C++ may have any length, but no compiler has to take more than 64 KB in one: the page is cut.
file(READ ${PAGE} page)
string(LENGTH "${page}" length)
set(part_length 15000)
set(parts "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${page}" ${at} ${part_length} part)
  string(APPEND parts "R\"page_of_weft(${part})page_of_weft\",\n")
  math(EXPR at "${at} + ${part_length}")
endwhile()
file(WRITE ${SOURCE} "// Made by embed_page.cmake.
#include \"tools/program/viewer/page_template.h\"

#include <string>

namespace weft::tools {
namespace {
// Not string_view, whose lengths the compiler would count character by character.
constexpr const char* kParts[]{
${parts}};
}  // namespace

std::string_view page_template() {
  static const std::string page = [] {
    std::string whole;
    for (const char* part : kParts) whole += part;
    return whole;
  }();
  return page;
}

}  // namespace weft::tools
")
