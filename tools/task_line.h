/// Which of many tasks is at work: one line on standard error, redrawn in place on a terminal;
/// elsewhere one line for each task.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace weft::tools {

class TaskLine {
 public:
  explicit TaskLine(std::size_t tasks);
  ~TaskLine();
  TaskLine(const TaskLine&) = delete;
  TaskLine& operator=(const TaskLine&) = delete;

  void next(std::string task);
  /// What the task is doing now: shown on a terminal, not more often than can be read.
  void show(std::string_view detail);

 private:
  std::size_t tasks_;
  std::size_t started_ = 0;
  std::string task_;
  bool redraws_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace weft::tools
