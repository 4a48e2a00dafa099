#include "tools/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "tools/wording.h"

namespace weft::tools {
namespace {

constexpr auto kPause = std::chrono::milliseconds(100);
constexpr int kWidth = 30;
constexpr auto kClearLine = "\r\033[K";

}  // namespace

Progress::Progress(int frames) : frames_(frames), is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (is_terminal_) fmt::print(stderr, kClearLine);
}

void Progress::show(int frame, double strain) {
  if (!is_terminal_ || Clock::now() < next_) return;
  next_ = Clock::now() + kPause;
  const auto done = static_cast<int>(static_cast<std::int64_t>(frame) * kWidth / frames_);
  fmt::print(stderr, "{}[{:#<{}}{:.<{}}] frame {}/{}, strain {}", kClearLine, "", done, "",
             kWidth - done, frame, frames_, measured_percent(strain));
  std::fflush(stderr);
}

}  // namespace weft::tools
