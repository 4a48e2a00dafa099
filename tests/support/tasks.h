/// Loops by tasks of oneTBB, as ThreadSanitizer can follow them.
#pragma once

#include <tbb/parallel_for.h>

#include <atomic>
#include <cstddef>

namespace weft::test {

/// work(i) for each i < count, in tasks of the arena that this thread is in. oneTBB as packaged is
/// not instrumented, so ThreadSanitizer does not see how it hands work over, and when that is done:
/// it sees these two atomics.
template <class Work>
void in_tasks(std::size_t count, const Work& work) {
  std::atomic<const Work*> handed_over{nullptr};
  std::atomic<std::size_t> done{0};
  handed_over.store(&work, std::memory_order_release);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    (*handed_over.load(std::memory_order_acquire))(i);
    done.fetch_add(1, std::memory_order_release);
  });
  (void)done.load(std::memory_order_acquire);
}

}  // namespace weft::test
