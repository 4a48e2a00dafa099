#include "tools/program/terminal/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "tools/program/files/text_file.h"

namespace weft::tools {

std::string bar(std::size_t done, std::size_t total, std::size_t width) {
  const std::size_t full = width * done / total;
  return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  const long long minutes = whole / 60, hours = minutes / 60;
  if (hours > 0) return fmt::format("{} h {} min", hours, minutes % 60);
  if (minutes > 0) return fmt::format("{} min {} s", minutes, whole % 60);
  return fmt::format("{} s", whole);
}

void TimeLeft::add(double seconds) {
  constexpr std::size_t kRemembered = 30;
  if (done_ < parts_) ++done_;
  mean_ += (seconds - mean_) / static_cast<double>(std::min(done_, kRemembered));
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
  const auto now = std::chrono::steady_clock::now();
  if (started_ > 0) left_.add(std::chrono::duration<double>(now - last_).count());
  last_ = now;
  const std::string filled = bar(started_, tasks_, 12);
  ++started_;
  if (!line_.redraws()) {
    print_message(fmt::format("{} {}/{} {}\n", filled, started_, tasks_, task));
    return;
  }
  const std::string left =
      left_.done() > 0 ? fmt::format(", about {} left", duration_text(left_.seconds())) : "";
  task_ = fmt::format("{} {}/{}{}: {}", filled, started_, tasks_, left, task);
  line_.draw(task_);
}

void TaskLine::show(std::string_view detail) { line_.show(fmt::format("{} {}", task_, detail)); }

}  // namespace weft::tools
