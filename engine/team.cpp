#include "engine/team.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace weft {
namespace {

constexpr std::uint32_t kStop = 0xffffffffu;
constexpr int kSpinsBeforeYield = 2000;

std::uint64_t call_of(std::uint64_t epoch, std::uint32_t members) { return epoch << 32 | members; }
std::uint32_t members_of(std::uint64_t call) { return static_cast<std::uint32_t>(call); }

/// Waits until ready() holds: spinning, since it is soon; yielding, if it is not.
template <class Ready>
void wait_until(Ready&& ready) {
  for (int spins = 0; !ready(); ++spins) {
    if (spins < kSpinsBeforeYield) {
      __builtin_ia32_pause();
    } else {
      std::this_thread::yield();
    }
  }
}

}  // namespace

Team::Team(int threads) {
  const int helpers = std::min(threads, tbb::this_task_arena::max_concurrency()) - 1;
  alone_ = helpers <= 0;
  for (int i = 0; i < helpers; ++i) tasks_.run([this] { serve(); });
}

Team::~Team() {
  if (alone_) return;
  call_.store(call_of(++epoch_, kStop), std::memory_order_release);
  tasks_.wait();
}

void Team::run(const Job& job) {
  const std::uint32_t members = 1 + (alone_ ? 0 : joined_.load(std::memory_order_relaxed));
  if (members == 1 || job.count < 2) {
    job.share(job.context, 0, job.count);
    return;
  }
  job_ = job;
  done_.store(0, std::memory_order_relaxed);
  call_.store(call_of(++epoch_, members), std::memory_order_release);
  do_share(job, 0, members);
  wait_until([&] { return done_.load(std::memory_order_acquire) == members - 1; });
}

/// A member beyond `members` of an epoch must not touch the job: the leader does not wait for it.
/// Epoch and members are one word so that it cannot mistake one call for the next.
void Team::serve() {
  std::uint64_t seen = call_.load(std::memory_order_acquire);
  if (members_of(seen) == kStop) return;
  const std::uint32_t me = 1 + joined_.fetch_add(1, std::memory_order_relaxed);
  for (;;) {
    std::uint64_t call = seen;
    wait_until([&] { return (call = call_.load(std::memory_order_acquire)) != seen; });
    seen = call;
    if (members_of(call) == kStop) return;
    if (me >= members_of(call)) continue;
    do_share(job_, me, members_of(call));
    done_.fetch_add(1, std::memory_order_release);
  }
}

void Team::do_share(const Job& job, std::uint32_t member, std::uint32_t members) {
  job.share(job.context, job.count * member / members, job.count * (member + 1) / members);
}

}  // namespace weft
