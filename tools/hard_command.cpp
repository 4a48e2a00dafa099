#include "tools/hard_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/hard/results.h"
#include "tools/hard/suite.h"
#include "tools/output_folder.h"
#include "tools/study_outputs.h"
#include "tools/task_line.h"

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
  auto outputs = StudyOutputs::open(options.json, options.out);
  if (!outputs) return Error{outputs.error()};
  const auto results = run_all(selected, options.quick);
  const auto done = outputs.value().write(
      hard::to_text(results), hard::to_json(results),
      [&](const std::filesystem::path& folder) { return write_folder(folder, results); });
  if (!done) return Error{done.error()};
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
