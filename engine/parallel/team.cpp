#include "engine/parallel/team.h"

#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <thread>
#include <utility>

namespace weft {
namespace {

/// Pauses before the leader claims shares that are not its own: some microseconds.
constexpr int kPausesBeforeHelp = 100;
/// Pauses before a waiting thread yields its processor: some tens of microseconds.
constexpr int kPausesBeforeYield = 2000;
/// Yields before a waiting thread sleeps, so that a long serial stage of a step does not keep the
/// processors of the workers busy. With nothing else to run these are some tenths of a millisecond.
constexpr int kYieldsBeforeSleep = 1000;
constexpr std::chrono::microseconds kSleep{50};

/// Pauses until ready() holds, at most so many times. Returns whether it does.
template <class Ready>
bool spin_until(int most, Ready&& ready) {
  for (int pauses = 0; pauses < most; ++pauses) {
    if (ready()) return true;
    __builtin_ia32_pause();
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

/// Sets how this thread rounds and treats denormal numbers, and restores it in the end.
class Rounding {
 public:
  explicit Rounding(std::uint32_t of_leader) { _mm_setcsr(of_leader); }
  ~Rounding() { _mm_setcsr(before_); }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;

 private:
  std::uint32_t before_ = _mm_getcsr();
};

}  // namespace

Team::SharedState::Loop Team::SharedState::Loop::from(std::uint64_t word) {
  return {word >> 8, static_cast<std::uint32_t>(word & 0xffu)};
}

std::uint64_t Team::SharedState::Loop::word() const { return number << 8 | shares; }

Team::SharedState::Loop Team::SharedState::publish(std::uint32_t shares) {
  const Loop loop{++loops, shares};
  published.loop.store(loop.word(), std::memory_order_release);
  return loop;
}

std::shared_ptr<Team::SharedState> Team::make_shared_state() {
  return std::make_shared<SharedState>();
}

/// Workers are enqueued, not spawned into a task_group: a thread of the arena that had just run out
/// of work overlooked spawned tasks for over a millisecond (oneTBB 2021.8), while enqueued ones
/// start within 10 to 30 microseconds. Tasks of an earlier team that have not started serve this
/// one. Either such a task sees that the team is open, or it no longer counts as pending here: the
/// order of these four accesses is sequentially consistent.
Team::Team(int threads, std::shared_ptr<SharedState> shared)
    : shared_(std::move(shared)),
      max_workers_(std::min({threads, kMaxSize, tbb::this_task_arena::max_concurrency()}) - 1) {
  if (max_workers_ <= 0) return;
  SharedState& s = *shared_;
  s.departed.store(0, std::memory_order_relaxed);
  s.max_workers.store(static_cast<std::uint32_t>(max_workers_), std::memory_order_relaxed);
  s.rounding = _mm_getcsr();
  s.publish(0);  // the end of the last team is no longer what workers see
  s.joined.store(0);
  while (s.pending.load() < max_workers_ && enqueue_worker()) continue;
}

/// Returns whether there was memory for the task. A worker that cannot be enqueued does not come.
bool Team::enqueue_worker() {
  shared_->pending.fetch_add(1);
  try {
    tbb::this_task_arena::enqueue([shared = shared_] { shared->run_task(); });
  } catch (const std::bad_alloc&) {
    shared_->pending.fetch_sub(1);
    return false;
  }
  return true;
}

/// Closes the team and waits until everybody who has joined departs.
Team::~Team() {
  if (max_workers_ <= 0) return;
  SharedState& s = *shared_;
  const std::uint32_t came = s.joined.exchange(SharedState::kClosed, std::memory_order_acq_rel);
  s.publish(SharedState::kEndOfTeam);
  wait_until([&] { return s.departed.load(std::memory_order_acquire) == came; });
}

std::uint32_t Team::joined() const {
  return max_workers_ > 0 ? shared_->joined.load(std::memory_order_relaxed) : 0;
}

void Team::run(const Job& job) {
  const auto shares = static_cast<std::uint32_t>(std::min<std::size_t>(1 + joined(), job.count));
  if (shares < 2) return job.work(job.context, 0, job.count);
  SharedState& s = *shared_;
  s.published.job = job;
  const SharedState::Loop loop = s.publish(shares);
  s.do_share(loop, 0);
  const auto done = [&] { return s.all_done(loop); };
  if (spin_until(kPausesBeforeHelp, done)) return;
  for (std::uint32_t share = 1; share < shares; ++share) s.claim_and_do(loop, share);
  wait_until(done);
}

void Team::SharedState::run_task() {
  pending.fetch_sub(1);
  if (const std::uint32_t me = join()) work_until_end(me);
}

/// Returns the worker's number, from 1 on, or 0 if the team is closed or complete.
std::uint32_t Team::SharedState::join() {
  std::uint32_t before = joined.load();
  do {
    if (before == kClosed || before >= max_workers.load(std::memory_order_relaxed)) return 0;
  } while (!joined.compare_exchange_weak(before, before + 1, std::memory_order_acq_rel));
  return before + 1;
}

void Team::SharedState::work_until_end(std::uint32_t me) {
  const Rounding as_the_leader(rounding);
  std::uint64_t seen = 0;  // no loop has this word
  for (;;) {
    const std::uint64_t last = seen;
    wait_until([&] { return (seen = published.loop.load(std::memory_order_acquire)) != last; });
    const Loop loop = Loop::from(seen);
    if (loop.shares == kEndOfTeam) break;
    if (me < loop.shares) claim_and_do(loop, me);
  }
  departed.fetch_add(1, std::memory_order_release);
}

bool Team::SharedState::is_done(const Loop& loop, std::uint32_t share) const {
  return progress[share].value.load(std::memory_order_acquire) >= 2 * loop.number;
}

bool Team::SharedState::all_done(const Loop& loop) const {
  std::uint32_t share = 1;
  while (share < loop.shares && is_done(loop, share)) ++share;
  return share == loop.shares;
}

/// Returns false if somebody else has claimed the share, or if the loop is over. The leader does
/// not leave a loop while a share of it is claimed and not done, so the job stays what it is.
bool Team::SharedState::claim(const Loop& loop, std::uint32_t share) {
  std::uint64_t before = progress[share].value.load(std::memory_order_relaxed);
  const std::uint64_t claimed = 2 * loop.number - 1;
  return before < claimed &&
         progress[share].value.compare_exchange_strong(before, claimed, std::memory_order_acq_rel);
}

void Team::SharedState::do_share(const Loop& loop, std::uint32_t share) {
  const Job& job = published.job;
  job.work(job.context, job.count * share / loop.shares, job.count * (share + 1) / loop.shares);
}

void Team::SharedState::claim_and_do(const Loop& loop, std::uint32_t share) {
  if (!claim(loop, share)) return;
  do_share(loop, share);
  progress[share].value.store(2 * loop.number, std::memory_order_release);
}

}  // namespace weft
