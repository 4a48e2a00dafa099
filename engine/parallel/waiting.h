/// How a thread waits for another one: it spins for a bounded number of pauses, then yields, and
/// sleeps in the end.
#pragma once

#include <chrono>
#include <thread>

#include "engine/parallel/processor.h"

namespace weft {

/// Pauses before a waiting thread yields its processor: some tens of microseconds.
inline constexpr int kPausesBeforeYield = 2000;
/// Yields before a waiting thread sleeps, so that a long serial stage of a step does not keep the
/// processors of the workers busy. With nothing else to run these are some tenths of a millisecond.
inline constexpr int kYieldsBeforeSleep = 1000;
inline constexpr std::chrono::microseconds kSleep{50};

/// Pauses until ready() holds, at most so many times. Returns whether it does.
template <class Ready>
bool spin_until(int most, Ready&& ready) {
  for (int pauses = 0; pauses < most; ++pauses) {
    if (ready()) return true;
    pause();
  }
  return ready();
}

template <class Ready>
void wait_until(Ready&& ready) {
  if (spin_until(kPausesBeforeYield, ready)) return;
  for (int yields = 0; yields < kYieldsBeforeSleep; ++yields) {
    if (ready()) return;
    std::this_thread::yield();
  }
  while (!ready()) std::this_thread::sleep_for(kSleep);
}

}  // namespace weft
