#include "tools/studies/plots/plotting.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

extern char** environ;

namespace weft::tools {
namespace {

namespace fs = std::filesystem;

/// Where the scripts may lie: in the source tree that the program was built from, or beside it.
std::vector<fs::path> plots_folders() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  std::vector<fs::path> folders;
#ifdef WEFT_PLOTS_DIR
  folders.emplace_back(WEFT_PLOTS_DIR);
#endif
  folders.push_back(program / "plots");
  folders.push_back(program.parent_path() / "tools" / "studies" / "plots");
  return folders;
}

/// The exit status of a program, or -1 if it could not be started or was killed.
int run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) {
    return -1;
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

}  // namespace

Result<void> plot(const std::string& script, const std::vector<std::string>& arguments) {
  const auto folders = plots_folders();
  const auto found = std::ranges::find_if(folders, [&](const fs::path& folder) {
    std::error_code ignored;
    return fs::exists(folder / script, ignored);
  });
  if (found == folders.end()) return Error{fmt::format("no pictures: {} not found", script)};
  const fs::path& folder = *found;
  std::vector<std::string> words{folder / "python", folder / script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  if (run_program(std::move(words)) == 0) return {};
  return Error{fmt::format("no pictures: {} failed", script)};
}

}  // namespace weft::tools
