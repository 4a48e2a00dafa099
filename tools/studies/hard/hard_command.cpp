#include "tools/studies/hard/hard_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tools/program/files/pending_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/terminal/progress.h"
#include "tools/studies/hard/results.h"
#include "tools/studies/hard/suite.h"
#include "tools/studies/study_outputs.h"

namespace weft::tools {
namespace {

struct HardOptions : StudyOptions {
  std::string name;
};

/// As many at a time as there are processors; results in the order of the cases. (Threads of our
/// own: one of oneTBB that waits within a step might take up another case.)
std::vector<hard::CaseResult> run_all(const std::vector<hard::Selected>& selected, bool quick) {
  TaskLine line(selected.size());
  std::vector<hard::CaseResult> results(selected.size());
  std::mutex turn;
  std::size_t next = 0;
  std::exception_ptr failure;
  const auto take = [&]() -> std::size_t {
    const std::lock_guard lock(turn);
    if (next < selected.size()) line.next(selected[next].name);
    return next++;
  };
  const auto work = [&] {
    try {
      for (std::size_t k = take(); k < selected.size(); k = take()) {
        results[k] = hard::run(selected[k], quick);
      }
    } catch (...) {  // out of memory
      const std::lock_guard lock(turn);
      failure = std::current_exception();
      next = selected.size();
    }
  };
  std::vector<std::jthread> others(std::max(1U, std::thread::hardware_concurrency()) - 1);
  for (std::jthread& other : others) other = std::jthread(work);
  work();
  others.clear();  // joins
  if (failure) std::rethrow_exception(failure);
  return results;
}

Result<void> write_folder(const std::filesystem::path& folder,
                          const std::vector<hard::CaseResult>& results) {
  if (auto done = write_file(folder / "hard.csv", hard::to_csv(results)); !done) return done;
  return write_file(folder / "hard.md", hard::to_markdown(results));
}

Result<int> run_hard(const HardOptions& options) {
  if (const auto any = offered({}); !any) return Error{any.error()};
  const auto selected = hard::select(options.name);
  if (selected.empty()) return Error{fmt::format("--case: no case is named '{}'", options.name)};
  auto outputs = StudyOutputs::open(options);
  if (!outputs) return Error{outputs.error()};
  const auto results = run_all(selected, options.quick);
  const auto done = outputs.value().write(
      hard::to_text(results), hard::to_json(results),
      [&](const std::filesystem::path& folder) { return write_folder(folder, results); });
  if (!done) return Error{done.error()};
  return hard::failed(results) > 0 ? kCaseFailed : kDone;
}

}  // namespace

void add_hard_command(CommandLine& line) {
  const auto options = std::make_shared<HardOptions>();
  Verb verb = line.add_verb(
      "hard", "Run the cases that break cloth engines: each has a figure and a bound", [options] {
        const auto result = run_hard(*options);
        return result ? result.value() : refuse(result.error());
      });
  add_study_options(verb, *options, "write hard.csv and hard.md into a folder",
                    "fewer steps: some two minutes");
  verb.option("--case", options->name, "only cases with this in their name");
}

}  // namespace weft::tools
