#include "tools/task_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace weft::tools {

TaskLine::TaskLine(std::size_t tasks) : tasks_(tasks), redraws_(isatty(STDERR_FILENO) != 0) {}

TaskLine::~TaskLine() {
  if (redraws_) fmt::print(stderr, "\r\033[K");
}

void TaskLine::next(std::string task) {
  constexpr std::size_t kWidth = 12;
  const std::size_t full = kWidth * started_ / tasks_;
  ++started_;
  task_ = fmt::format("[{:#<{}}{:.<{}}] {}/{} {}", "", full, "", kWidth - full, started_, tasks_,
                      std::move(task));
  if (!redraws_) fmt::print(stderr, "{}\n", task_);
}

void TaskLine::show(std::string_view detail) {
  const auto now = std::chrono::steady_clock::now();
  if (!redraws_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  fmt::print(stderr, "\r{} {}\033[K", task_, detail);
  std::fflush(stderr);
}

}  // namespace weft::tools
