#include "engine/team.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace weft {
namespace {

constexpr std::uint32_t kStop = 0xffffffffu;
/// Pauses before a waiting thread gives its processor away: some tens of microseconds.
constexpr int kPatience = 2000;

std::uint64_t call_of(std::uint64_t epoch, std::uint32_t members) { return epoch << 32 | members; }
std::uint64_t epoch_of(std::uint64_t call) { return call >> 32; }
std::uint32_t members_of(std::uint64_t call) { return static_cast<std::uint32_t>(call); }

/// Waits until ready() holds. Returns whether that was soon.
template <class Ready>
bool wait_until(Ready&& ready) {
  for (int spins = 0; !ready(); ++spins) {
    if (spins < kPatience) {
      __builtin_ia32_pause();
      continue;
    }
    while (!ready()) std::this_thread::yield();
    return false;
  }
  return true;
}

}  // namespace

Team::Team(int threads)
    : helpers_(std::min({threads, kMostMembers, tbb::this_task_arena::max_concurrency()}) - 1),
      alone_(helpers_ <= 0) {
  for (int i = 0; i < helpers_; ++i) tasks_.run([this] { serve(); });
}

Team::~Team() {
  if (helpers_ <= 0) return;
  call_.store(call_of(++epoch_, kStop), std::memory_order_release);
  tasks_.wait();
}

void Team::run(const Job& job) {
  const std::uint32_t members = 1 + (alone_ ? 0 : joined_.load(std::memory_order_relaxed));
  if (members == 1 || job.count < 2) return job.work(job.context, 0, job.count);
  job_ = job;
  done_.store(0, std::memory_order_relaxed);
  call_.store(call_of(++epoch_, members), std::memory_order_release);
  take_shares(epoch_, 0, members);
  alone_ = !wait_until([&] { return done_.load(std::memory_order_acquire) == members; });
}

/// Epoch and members are one word so that a thread cannot mistake one call for the next. A share
/// that is begun in an epoch keeps the leader in it; a thread that has begun none must not touch
/// the job.
void Team::serve() {
  std::uint64_t call = call_.load(std::memory_order_acquire);
  if (members_of(call) == kStop) return;
  const std::uint32_t me = 1 + joined_.fetch_add(1, std::memory_order_relaxed);
  for (;;) {
    const std::uint64_t seen = call;
    wait_until([&] { return (call = call_.load(std::memory_order_acquire)) != seen; });
    if (members_of(call) == kStop) return;
    if (me < members_of(call)) take_shares(epoch_of(call), me, members_of(call));
  }
}

/// One's own share first, so that the same data stays with the same processor.
void Team::take_shares(std::uint64_t epoch, std::uint32_t me, std::uint32_t members) {
  for (std::uint32_t k = 0; k < members; ++k) {
    const std::uint32_t share = (me + k) % members;
    std::uint64_t before = shares_[share].begun.load(std::memory_order_relaxed);
    if (before >= epoch) continue;
    if (!shares_[share].begun.compare_exchange_strong(before, epoch, std::memory_order_acq_rel)) {
      continue;
    }
    job_.work(job_.context, job_.count * share / members, job_.count * (share + 1) / members);
    done_.fetch_add(1, std::memory_order_release);
  }
}

}  // namespace weft
