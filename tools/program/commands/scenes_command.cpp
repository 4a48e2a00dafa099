#include "tools/program/commands/scenes_command.h"

#include <fmt/format.h>

#include "tools/program/files/text_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/wrapping.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

std::string lines_of(bool is_fabric) {
  constexpr std::size_t kColumn = 18;
  std::string lines;
  for (const scenes::BuiltIn& scene : scenes::list()) {
    if (scene.is_fabric == is_fabric)
      lines += in_columns(fmt::format("  {}", scene.name), scene.summary, kColumn);
  }
  return lines;
}

std::string text() {
  return fmt::format(
      "Scenes of rigid edges; a --material makes fabric of all but chain:\n{}\n"
      "Scenes of {}, or of another --material:\n{}\n"
      "weft run NAME runs one, and --size N takes N particles along a side.\n",
      lines_of(false), scenes::kFabric, lines_of(true));
}

}  // namespace

void add_scenes_command(CommandLine& line) {
  line.add_verb("scenes", "List the scenes that are built in", [] {
    const auto printed = print_text(text());
    return printed ? kDone : refuse(printed.error());
  });
}

}  // namespace weft::tools
