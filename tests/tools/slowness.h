/// What takes longer than it did, without any more work to do.
#pragma once

#include <signal.h>
#include <sys/time.h>
#include <time.h>

namespace weft::tools {

/// While it lives this process sleeps for most of the time, wherever it is.
class Slowness {
 public:
  Slowness() : usual_(signal(SIGALRM, doze)) { wake_for_a_while(); }
  ~Slowness() {
    const itimerval never{};
    setitimer(ITIMER_REAL, &never, nullptr);
    signal(SIGALRM, usual_);
  }
  Slowness(const Slowness&) = delete;
  Slowness& operator=(const Slowness&) = delete;

 private:
  static void wake_for_a_while() {
    const itimerval once{{0, 0}, {0, 1'000}};
    setitimer(ITIMER_REAL, &once, nullptr);
  }
  static void doze(int) {
    const timespec nap{0, 5'000'000};
    nanosleep(&nap, nullptr);
    wake_for_a_while();
  }

  void (*usual_)(int);
};

}  // namespace weft::tools
