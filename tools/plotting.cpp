#include "tools/plotting.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <system_error>

extern char** environ;

namespace weft::tools {
namespace {

namespace fs = std::filesystem;

/// The source tree's folder, or one named `plots` beside the program if it has moved.
fs::path plots_folder() {
  std::error_code ignored;
#ifdef WEFT_PLOTS_DIR
  if (fs::exists(WEFT_PLOTS_DIR, ignored)) return WEFT_PLOTS_DIR;
#endif
  return fs::read_symlink("/proc/self/exe", ignored).parent_path() / "plots";
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
  const fs::path folder = plots_folder();
  std::error_code ignored;
  if (!fs::exists(folder / script, ignored)) {
    return Error{fmt::format("no pictures: {} not found", (folder / script).string())};
  }
  std::vector<std::string> words{folder / "python", folder / script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  if (run_program(std::move(words)) == 0) return {};
  return Error{fmt::format("no pictures: {} failed", script)};
}

}  // namespace weft::tools
