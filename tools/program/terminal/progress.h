/// What is at work, on standard error while it lasts.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace weft::tools {

/// "[####......]"
std::string bar(std::size_t done, std::size_t total, std::size_t width);

/// One line that is redrawn in place, only on a terminal; cleared in the end.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool redraws() const { return redraws_; }
  void draw(std::string_view text);
  /// Not more often than can be read.
  void show(std::string_view text);

 private:
  bool redraws_;
  std::chrono::steady_clock::time_point drawn_;
};

/// Which of many tasks is at work: a progress line; where that is not redrawn, one line for each
/// task.
class TaskLine {
 public:
  explicit TaskLine(std::size_t tasks) : tasks_(tasks) {}

  void next(std::string_view task);
  /// What the task is doing now.
  void show(std::string_view detail);

 private:
  std::size_t tasks_;
  std::size_t started_ = 0;
  std::string task_;
  ProgressLine line_;
};

}  // namespace weft::tools
