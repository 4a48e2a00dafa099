#include "tools/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace weft::tools {

std::string bar(std::size_t done, std::size_t total, std::size_t width) {
  const std::size_t full = width * done / total;
  return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

ProgressLine::ProgressLine() : redraws_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (redraws_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(std::string_view text) {
  const auto now = std::chrono::steady_clock::now();
  if (!redraws_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  fmt::print(stderr, "\r{}\033[K", text);
  std::fflush(stderr);
}

void TaskLine::next(std::string_view task) {
  const std::string filled = bar(started_, tasks_, 12);
  ++started_;
  task_ = fmt::format("{} {}/{} {}", filled, started_, tasks_, task);
  if (!line_.redraws()) fmt::print(stderr, "{}\n", task_);
}

void TaskLine::show(std::string_view detail) { line_.show(fmt::format("{} {}", task_, detail)); }

}  // namespace weft::tools
