#include "tools/program/files/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace weft::tools {
namespace {

bool is_device(std::FILE* file) {
  struct stat status {};
  return fstat(fileno(file), &status) == 0 && (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode));
}

}  // namespace

Result<std::string> read_text_file(const std::string& path) {
  const auto refused = [&] {
    return Error{fmt::format("cannot read '{}': {}", path, std::strerror(errno))};
  };
  const auto close = [](std::FILE* stream) { std::fclose(stream); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rbe"), close);
  if (!file) return refused();
  if (is_device(file.get()))
    return Error{fmt::format("cannot read '{}': it is a device, not a file", path)};
  std::string text;
  std::array<char, 1 << 16> block{};
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), size);
  }
  if (std::ferror(file.get())) return refused();
  return text;
}

Result<void> print_text(std::string_view text) {
  const bool complete =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!complete) return Error{fmt::format("cannot write to stdout: {}", std::strerror(errno))};
  return {};
}

void print_message(std::string_view text) {
  [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// The lowest one that is free is the next to be opened: those before it are open already.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace weft::tools
