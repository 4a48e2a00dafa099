#include "tools/hard_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/hard/results.h"
#include "tools/hard/suite.h"
#include "tools/json_output.h"
#include "tools/output_folder.h"
#include "tools/task_line.h"
#include "tools/text_file.h"

namespace weft::tools {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitRefused = 2;

struct HardOptions {
  std::string json;
  std::string out;
  std::string name;
  bool quick = false;
};

std::vector<hard::CaseResult> run_all(const std::vector<hard::Selected>& selected, bool quick) {
  TaskLine line(selected.size());
  std::vector<hard::CaseResult> results;
  for (const hard::Selected& one : selected) {
    line.next(one.name);
    results.push_back(hard::run(one, quick));
  }
  return results;
}

Result<void> write_folder(const std::filesystem::path& folder,
                          const std::vector<hard::CaseResult>& results) {
  if (auto done = write_file(folder / "hard.csv", hard::to_csv(results)); !done) return done;
  return write_file(folder / "hard.md", hard::to_markdown(results));
}

Result<int> run_hard(const HardOptions& options) {
  const auto selected = hard::select(options.name);
  if (selected.empty()) return Error{fmt::format("--case: no case is named '{}'", options.name)};
  std::optional<JsonOutput> json;
  if (!options.json.empty()) {
    auto opened = JsonOutput::open(options.json);
    if (!opened) return Error{fmt::format("--json: {}", opened.error())};
    json = std::move(opened.value());
  }
  if (!options.out.empty()) {
    if (auto made = make_output_folder(options.out); !made) return Error{made.error()};
  }
  const auto results = run_all(selected, options.quick);

  if (!options.out.empty()) {
    if (auto done = write_folder(options.out, results); !done) return Error{done.error()};
  }
  if (json) {
    if (auto done = json->write(hard::to_json(results)); !done) return Error{done.error()};
  }
  if (!json || !json->is_stdout()) {
    if (auto done = print_text(hard::to_text(results)); !done) return Error{done.error()};
  }
  return hard::failed(results) > 0 ? kExitFailed : 0;
}

}  // namespace

void add_hard_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<HardOptions>();
  CLI::App* verb = app.add_subcommand(
      "hard", "Run the cases that break cloth engines: each has a figure and a bound");
  verb->add_option("--json", options->json, "write the results as JSON; - for standard output");
  verb->add_option("--out", options->out, "write hard.csv and hard.md into a folder");
  verb->add_option("--case", options->name, "only cases with this in their name");
  verb->add_flag("--quick", options->quick, "fewer steps: under a minute");
  verb->callback([options, &exit_code] {
    const auto result = run_hard(*options);
    exit_code = result ? result.value() : kExitRefused;
    if (!result) fmt::print(stderr, "weft: {}\n", result.error());
  });
}

}  // namespace weft::tools
