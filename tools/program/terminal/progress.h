/// What is at work, on standard error while it lasts.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace weft::tools {

/// "[####......]"
std::string bar(std::size_t done, std::size_t total, std::size_t width);

/// "8 s", "3 min 20 s", "2 h 5 min": in whole seconds, upwards.
std::string duration_text(double seconds);

/// How long a task of many parts still takes, as the parts that are done tell: the last thirty
/// count most, so that a slow beginning is forgotten.
class TimeLeft {
 public:
  explicit TimeLeft(std::size_t parts) : parts_(parts) {}

  void add(double seconds);  ///< a part is done
  std::size_t done() const { return done_; }
  double seconds() const { return mean_ * static_cast<double>(parts_ - done_); }

 private:
  std::size_t parts_;
  std::size_t done_ = 0;
  double mean_ = 0;  ///< s, of a part
};

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

/// Which of many tasks is at work, and how long all of them still take: a progress line; where that
/// is not redrawn, one line for each task.
class TaskLine {
 public:
  explicit TaskLine(std::size_t tasks) : tasks_(tasks), left_(tasks) {}

  void next(std::string_view task);
  /// What the task is doing now.
  void show(std::string_view detail);

 private:
  std::size_t tasks_;
  std::size_t started_ = 0;
  TimeLeft left_;
  std::chrono::steady_clock::time_point last_;
  std::string task_;
  ProgressLine line_;
};

}  // namespace weft::tools
