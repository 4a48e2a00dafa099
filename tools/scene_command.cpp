#include "tools/scene_command.h"

#include <fmt/format.h>

#include <memory>

#include "tools/exit_code.h"
#include "tools/file_ending.h"
#include "tools/pending_file.h"
#include "tools/scene_file.h"
#include "tools/scene_source.h"

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
  const auto source = load_scene(options.scene);
  if (!source) return Error{source.error()};
  if (auto model = build_model(source.value().description); !model) return Error{model.error()};
  const auto written = write_file(options.out, scene_text(source.value().description));
  if (!written) return Error{fmt::format("--out: {}", written.error())};
  return {};
}

}  // namespace

void add_scene_command(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("scene", "Write a scene as a JSON file");
  auto options = std::make_shared<WriteOptions>();
  add_scene_options(*verb, options->scene);
  verb->add_option("--out", options->out, "the .json file to write")->required();
  verb->callback([options, &exit_code] {
    const auto written = write_scene(*options);
    exit_code = written ? kDone : refuse(written.error());
  });
}

}  // namespace weft::tools
