#include "tests/support/job_systems.h"

#include <chrono>

namespace weft::test {

Pool::Pool(int threads) {
  for (int k = 1; k < threads; ++k) threads_.emplace_back([this] { work_until_closed(); });
}

Pool::~Pool() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

JobSystem Pool::jobs() {
  return {.host = this,
          .threads =
              [](void* host) noexcept {
                return 1 + static_cast<int>(static_cast<Pool*>(host)->threads_.size());
              },
          .run = [](void* host, Job job,
                    int times) noexcept { static_cast<Pool*>(host)->run(job, times); }};
}

void Pool::run(Job job, int times) {
  int left = times;
  std::unique_lock lock(mutex_);
  for (int k = 0; k < times; ++k) queue_.push_back({job, &left});
  changed_.notify_all();
  while (left > 0) {
    if (queue_.empty())
      changed_.wait(lock);
    else
      make(lock);
  }
}

/// The next call, without the lock.
void Pool::make(std::unique_lock<std::mutex>& lock) {
  const Call call = queue_.front();
  queue_.pop_front();
  lock.unlock();
  call.job();
  lock.lock();
  if (--*call.left == 0) changed_.notify_all();
}

void Pool::work_until_closed() {
  std::unique_lock lock(mutex_);
  while (!closed_) {
    if (queue_.empty())
      changed_.wait(lock);
    else
      make(lock);
  }
}

JobSystem OddHost::jobs() {
  return {.host = this,
          .threads = [](void* host) noexcept { return static_cast<OddHost*>(host)->threads_; },
          .run = [](void* host, Job job,
                    int times) noexcept { static_cast<OddHost*>(host)->run_(job, times); }};
}

OddHost at_once(int threads) {
  return {threads, [](Job job, int times) {
            for (int k = 0; k < times; ++k) job();
          }};
}

OddHost in_turns(int threads) {
  return {threads, [](Job job, int times) {
            for (int k = 0; k < times; ++k) std::thread(job).join();
          }};
}

OddHost backwards(int threads) {
  return {threads, [](Job job, int times) {
            std::vector<std::thread> callers;
            for (int k = 0; k < times; ++k) {
              callers.emplace_back([job, wait = std::chrono::microseconds(100 * (times - k))] {
                std::this_thread::sleep_for(wait);
                job();
              });
            }
            for (std::thread& caller : callers) caller.join();
          }};
}

OddHost without_calls(int threads) {
  return {threads, [](Job, int) {}};
}

}  // namespace weft::test
