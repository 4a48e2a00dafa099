#include "tools/program/commands/scene_command.h"

#include <fmt/format.h>

#include <memory>

#include "tools/program/files/pending_file.h"
#include "tools/program/formats/scene_file.h"
#include "tools/program/options/scene_source.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/file_ending.h"

namespace weft::tools {
namespace {

struct WriteOptions {
  SceneOptions scene;
  std::string out;
};

Result<void> write_scene(const WriteOptions& options) {
  if (file_ending(options.out) != ".json") {
    return Error{fmt::format("--out: '{}' does not end in .json", options.out)};
  }
  auto source = load_scene(options.scene);
  if (!source) return Error{source.error()};
  if (auto model = model_of(source.value()); !model) return Error{model.error()};
  const auto written =
      write_file(options.out, scene_text(source.value().description, source.value().moves,
                                         particle_faces(source.value().mesh), source.value().bodies,
                                         source.value().events, source.value().rest_scale));
  if (!written) return Error{fmt::format("--out: {}", written.error())};
  return {};
}

}  // namespace

void add_scene_command(CommandLine& line) {
  auto options = std::make_shared<WriteOptions>();
  Verb verb = line.add_verb("scene", "Write a scene as a JSON file", [options] {
    const auto written = write_scene(*options);
    return written ? kDone : refuse(written.error());
  });
  add_scene_options(verb, options->scene);
  verb.group("Files");
  verb.required("--out", options->out, "the .json file to write");
}

}  // namespace weft::tools
