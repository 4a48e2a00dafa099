/// A progress line on standard error while a run lasts, only if that is a terminal.
#pragma once

#include <chrono>

namespace weft::tools {

class Progress {
 public:
  explicit Progress(int frames);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// strain: of this frame.
  void show(int frame, double strain);

 private:
  using Clock = std::chrono::steady_clock;

  int frames_;
  bool is_terminal_;
  Clock::time_point next_ = Clock::now();
};

}  // namespace weft::tools
