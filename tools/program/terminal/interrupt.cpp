#include "tools/program/terminal/interrupt.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>

#include "tools/program/files/pending_file.h"
#include "tools/program/terminal/exit_code.h"

namespace weft::tools {
namespace {

bool stderr_is_terminal = false;  // asked before any signal can come
volatile std::sig_atomic_t orderly = 0;
volatile std::sig_atomic_t received = 0;

/// There may be a progress line to leave.
template <std::size_t kSize>
void say(const char (&line)[kSize]) {
  if (stderr_is_terminal) [[maybe_unused]]
    const auto left = write(STDERR_FILENO, "\n", 1);
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, kSize - 1);
}

extern "C" void handle_interrupt(int signal) {
  if (signal != SIGPIPE && orderly != 0 && received == 0) {
    received = signal;
    const int kept = errno;  // of what was interrupted
    say("weft: stops after this frame; once more to stop at once\n");
    errno = kept;
    return;
  }
  // A terminal that closes sends one, and its shell another.
  if (signal == SIGHUP && received == SIGHUP) return;
  remove_pending_files();
  if (signal == SIGPIPE) _exit(interrupted_by(signal));  // nobody reads any more
  say("weft: interrupted\n");
  _exit(interrupted_by(signal));
}

}  // namespace

void install_interrupt_handler() {
  stderr_is_terminal = isatty(STDERR_FILENO) == 1;
  struct sigaction action {};
  action.sa_handler = handle_interrupt;
  action.sa_flags = SA_RESTART;  // output is to be complete: writing goes on
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  for (const int signal : {SIGHUP, SIGPIPE}) {
    struct sigaction present {};  // ignored, as SIGHUP is under nohup, and then left so
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  signal(SIGXFSZ, SIG_IGN);  // writing fails then, and says so
}

OrderlyInterrupt::OrderlyInterrupt() {
  received = 0;
  orderly = 1;
}
OrderlyInterrupt::~OrderlyInterrupt() { orderly = 0; }
int OrderlyInterrupt::signal() { return received; }

}  // namespace weft::tools
