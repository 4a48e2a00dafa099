/// A meeting of threads: they may join while it is open, and the thread that closes it waits for
/// them. Late threads find it closed.
#pragma once

#include <atomic>
#include <cstdint>

#include "engine/parallel/waiting.h"

namespace weft {

class Gathering {
 public:
  /// For so many; by its owner alone, as close().
  void open(std::uint32_t places) {
    left_.store(0, std::memory_order_relaxed);
    places_.store(places, std::memory_order_relaxed);
    joined_.store(0);
  }
  /// Nobody joins any more. Returns how many have.
  std::uint32_t close() { return joined_.exchange(kClosed, std::memory_order_acq_rel); }
  void wait_until_left(std::uint32_t by) const {
    wait_until([&] { return left_.load(std::memory_order_acquire) == by; });
  }
  /// How many have come. While it is open.
  std::uint32_t joined() const { return joined_.load(std::memory_order_relaxed); }
  std::uint32_t places() const { return places_.load(std::memory_order_relaxed); }

  /// The number of the thread that joins, from 1 on, or 0 if it is closed or full.
  std::uint32_t join() {
    std::uint32_t before = joined_.load();
    do {
      if (before == kClosed || before >= places()) return 0;
    } while (!joined_.compare_exchange_weak(before, before + 1, std::memory_order_acq_rel));
    return before + 1;
  }
  /// The last call of a thread that has joined.
  void leave() { left_.fetch_add(1, std::memory_order_release); }

 private:
  static constexpr std::uint32_t kClosed = 0xffffffffu;

  std::atomic<std::uint32_t> joined_{kClosed};
  std::atomic<std::uint32_t> places_{0};
  std::atomic<std::uint32_t> left_{0};
};

}  // namespace weft
