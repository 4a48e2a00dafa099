#include "engine/solvers/team.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace weft {
namespace {

constexpr std::uint32_t kStop = 0xffffffffu;
/// Pauses before the leader begins a share that is not its own: some microseconds.
constexpr int kGrace = 100;
/// Pauses before a waiting thread gives its processor away: some tens of microseconds.
constexpr int kPatience = 2000;
/// A share that takes so much longer than the leader's own is on a thread without a processor.
constexpr std::chrono::milliseconds kLost{1};

std::uint64_t call_of(std::uint64_t epoch, std::uint32_t members) { return epoch << 32 | members; }
std::uint64_t epoch_of(std::uint64_t call) { return call >> 32; }
std::uint32_t members_of(std::uint64_t call) { return static_cast<std::uint32_t>(call); }

/// Spins until ready() holds, at most so many times. Returns whether it does.
template <class Ready>
bool spin_until(int most, Ready&& ready) {
  for (int spins = 0; spins < most; ++spins) {
    if (ready()) return true;
    __builtin_ia32_pause();
  }
  return ready();
}

/// Waits until ready() holds. Returns whether it took less than kLost.
template <class Ready>
bool wait_until(Ready&& ready) {
  if (spin_until(kPatience, ready)) return true;
  const auto start = std::chrono::steady_clock::now();
  while (!ready()) std::this_thread::yield();
  return std::chrono::steady_clock::now() - start < kLost;
}

}  // namespace

Team::Team(int threads)
    : helpers_(std::min({threads, kMostMembers, tbb::this_task_arena::max_concurrency()}) - 1),
      alone_(helpers_ <= 0) {
  for (int i = 0; i < helpers_; ++i) tasks_.run([this] { serve(); });
}

Team::~Team() {
  if (helpers_ <= 0) return;
  call_.word.store(call_of(++epoch_, kStop), std::memory_order_release);
  tasks_.wait();
}

void Team::run(const Job& job) {
  const std::uint32_t members = 1 + (alone_ ? 0 : joined_.load(std::memory_order_relaxed));
  if (members == 1 || job.count < 2) return job.work(job.context, 0, job.count);
  call_.job = job;
  call_.word.store(call_of(++epoch_, members), std::memory_order_release);
  do_share(epoch_, 0, members);
  for (std::uint32_t share = 1; share < members; ++share) {
    if (!finish_share(epoch_, share, members)) alone_ = true;
  }
}

/// Sees to it that the share of a member gets done. Returns whether that went smoothly.
bool Team::finish_share(std::uint64_t epoch, std::uint32_t share, std::uint32_t members) {
  const auto done = [&] { return shares_[share].done.load(std::memory_order_acquire) == epoch; };
  if (spin_until(kGrace, done)) return true;
  do_share(epoch, share, members);
  return wait_until(done);
}

/// Epoch and members are one word so that a thread cannot mistake one call for the next. A share
/// that is begun in an epoch keeps the leader in it; a thread that has begun none must not touch
/// the job.
void Team::serve() {
  std::uint64_t call = call_.word.load(std::memory_order_acquire);
  if (members_of(call) == kStop) return;
  const std::uint32_t me = 1 + joined_.fetch_add(1, std::memory_order_relaxed);
  for (;;) {
    const std::uint64_t seen = call;
    wait_until([&] { return (call = call_.word.load(std::memory_order_acquire)) != seen; });
    if (members_of(call) == kStop) return;
    if (me < members_of(call)) do_share(epoch_of(call), me, members_of(call));
  }
}

/// Unless somebody has begun it.
void Team::do_share(std::uint64_t epoch, std::uint32_t share, std::uint32_t members) {
  std::uint64_t before = shares_[share].begun.load(std::memory_order_relaxed);
  if (before >= epoch) return;
  if (!shares_[share].begun.compare_exchange_strong(before, epoch, std::memory_order_acq_rel))
    return;
  const Job& job = call_.job;
  job.work(job.context, job.count * share / members, job.count * (share + 1) / members);
  shares_[share].done.store(epoch, std::memory_order_release);
}

}  // namespace weft
