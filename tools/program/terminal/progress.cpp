#include "tools/program/terminal/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include "tools/program/files/text_file.h"

namespace weft::tools {

std::string bar(std::size_t done, std::size_t total, std::size_t width) {
  const std::size_t full = width * done / total;
  return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

ProgressLine::ProgressLine() : redraws_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (redraws_) print_message("\r\033[K");
}

void ProgressLine::draw(std::string_view text) {
  if (!redraws_) return;
  drawn_ = std::chrono::steady_clock::now();
  print_message(fmt::format("\r{}\033[K", text));
}

void ProgressLine::show(std::string_view text) {
  if (std::chrono::steady_clock::now() - drawn_ >= std::chrono::milliseconds(100)) draw(text);
}

void TaskLine::next(std::string_view task) {
  const std::string filled = bar(started_, tasks_, 12);
  ++started_;
  task_ = fmt::format("{} {}/{} {}", filled, started_, tasks_, task);
  if (line_.redraws()) {
    line_.draw(task_);
  } else {
    print_message(task_ + "\n");
  }
}

void TaskLine::show(std::string_view detail) { line_.show(fmt::format("{} {}", task_, detail)); }

}  // namespace weft::tools
