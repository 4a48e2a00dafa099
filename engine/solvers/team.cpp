#include "engine/solvers/team.h"

#include <sched.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace weft {
namespace {

constexpr std::uint32_t kStop = 0xffffu;
constexpr std::uint32_t kClosed = 0xffffffffu;
/// Pauses before the leader begins a share that is not its own: some microseconds.
constexpr int kGrace = 100;
/// Pauses before a waiting thread gives its processor away: some tens of microseconds.
constexpr int kPatience = 2000;
/// Ticks of the processor's clock, about a millisecond. A share that takes so much longer than
/// twice the leader's own is on a thread without a processor.
constexpr std::uint64_t kLost = 3'000'000;
/// Ticks that a task waits at the door at most: 0.2 ms.
constexpr std::uint64_t kLinger = 600'000;
/// The leader then goes on alone for so many times what it waited, so that lost processors cost no
/// more than this part of the time.
constexpr std::uint64_t kAlone = 8;

/// By all teams.
std::atomic<std::uint64_t> tasks_enqueued{0};

std::uint64_t call_of(std::uint64_t epoch, std::uint32_t members) { return epoch << 16 | members; }
std::uint64_t epoch_of(std::uint64_t call) { return call >> 16; }
std::uint32_t members_of(std::uint64_t call) { return call & 0xffffu; }

std::uint64_t ticks() { return __builtin_ia32_rdtsc(); }

/// Spins until ready() holds, at most so many times. Returns whether it does.
template <class Ready>
bool spin_until(int most, Ready&& ready) {
  for (int spins = 0; spins < most; ++spins) {
    if (ready()) return true;
    __builtin_ia32_pause();
  }
  return ready();
}

template <class Ready>
void wait_until(Ready&& ready) {
  if (spin_until(kPatience, ready)) return;
  while (!ready()) std::this_thread::yield();
}

/// Linux may wake a thread on the processor of who wakes it, though others are idle: in a virtual
/// machine these look as if they were taken. It stays there for many milliseconds, unless it is
/// told to go.
void leave_processor(int processor) {
  cpu_set_t allowed, others;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  others = allowed;
  CPU_CLR(processor, &others);
  if (CPU_COUNT(&others) == 0 || sched_setaffinity(0, sizeof others, &others) != 0) return;
  sched_setaffinity(0, sizeof allowed, &allowed);
}

}  // namespace

Team::Meeting::Meeting() : door(kClosed) {}

std::shared_ptr<Team::Meeting> Team::make_meeting() { return std::make_shared<Meeting>(); }

// Enqueued, not spawned into a task_group: a worker that had just run out of work overlooked
// spawned tasks for over a millisecond (oneTBB 2021.8), enqueued ones start within 10 to 30 us.
// Nothing waits for a task that has not started; it only counts as asked for.
Team::Team(int threads, std::shared_ptr<Meeting> meeting)
    : meeting_(std::move(meeting)),
      helpers_(std::min({threads, kMostMembers, tbb::this_task_arena::max_concurrency()}) - 1) {
  if (helpers_ <= 0) return;
  Meeting& m = *meeting_;
  const auto helpers = static_cast<std::uint32_t>(helpers_);
  m.left.store(0, std::memory_order_relaxed);
  m.seats.store(helpers, std::memory_order_relaxed);
  m.leaders_processor.store(sched_getcpu(), std::memory_order_relaxed);
  m.call.word.store(call_of(++m.epoch, 1), std::memory_order_relaxed);
  m.door.store(0);
  while (m.asked.load() < helpers_) {
    m.asked.fetch_add(1);
    tasks_enqueued.fetch_add(1, std::memory_order_relaxed);
    tbb::this_task_arena::enqueue([shared = meeting_] { shared->attend(); });
  }
}

/// Closes the door and waits for those who had come in.
Team::~Team() {
  if (helpers_ <= 0) return;
  Meeting& m = *meeting_;
  m.leaders_processor.store(sched_getcpu(), std::memory_order_relaxed);  // it may have moved
  const std::uint32_t came = m.door.exchange(kClosed, std::memory_order_acq_rel);
  m.call.word.store(call_of(++m.epoch, kStop), std::memory_order_release);
  wait_until([&] { return m.left.load(std::memory_order_acquire) == came; });
}

/// How many share the next loop.
std::uint32_t Team::members() {
  if (helpers_ <= 0) return 1;
  if (alone_until_ > 0 && ticks() < alone_until_) return 1;
  alone_until_ = 0;
  return 1 + meeting_->door.load(std::memory_order_relaxed);
}

void Team::run(const Job& job) {
  Meeting& m = *meeting_;
  const std::uint32_t members = this->members();
  if (members == 1 || job.count < 2) return job.work(job.context, 0, job.count);
  m.call.job = job;
  m.call.word.store(call_of(++m.epoch, members), std::memory_order_release);
  const std::uint64_t start = ticks();
  m.do_share(m.epoch, 0, members);
  const std::uint64_t own = ticks() - start;
  for (std::uint32_t share = 1; share < members; ++share) finish_share(share, members);
  const std::uint64_t end = ticks(), waited = end - start - own;
  if (waited > own + kLost) alone_until_ = end + kAlone * waited;
}

/// Sees to it that the share of a member gets done.
void Team::finish_share(std::uint32_t share, std::uint32_t members) {
  Meeting& m = *meeting_;
  const auto done = [&] { return m.shares[share].done.load(std::memory_order_acquire) == m.epoch; };
  if (spin_until(kGrace, done)) return;
  m.do_share(m.epoch, share, members);
  wait_until(done);
}

/// The life of a task.
void Team::Meeting::attend() {
  std::uint64_t patience = 0;
  while (const std::uint32_t me = come_in(patience)) {
    const std::uint64_t start = ticks();
    take_part(me);
    patience = std::min(kLinger, ticks() - start);
  }
}

/// Waits at the door, patience in ticks. Returns the member's number, 0 for none. Other threads
/// that are ready to run on this processor may.
std::uint32_t Team::Meeting::come_in(std::uint64_t patience) {
  const std::uint64_t start = ticks(), enqueued = tasks_enqueued.load(std::memory_order_relaxed);
  std::uint32_t me = 0;
  const int leaders = leaders_processor.load(std::memory_order_relaxed);
  if (leaders == sched_getcpu()) leave_processor(leaders);
  const auto entered = [&] { return (me = enter()) > 0; };
  while (!spin_until(kGrace, entered) && ticks() - start < patience &&
         tasks_enqueued.load(std::memory_order_relaxed) == enqueued) {
    std::this_thread::yield();
  }
  asked.fetch_sub(1);
  return me > 0 ? me : enter();  // a team that has just come may have counted on this task
}

std::uint32_t Team::Meeting::enter() {
  std::uint32_t came = door.load();
  do {
    if (came == kClosed || came >= seats.load(std::memory_order_relaxed)) return 0;
  } while (!door.compare_exchange_weak(came, came + 1, std::memory_order_acq_rel));
  return came + 1;
}

/// Epoch and members are one word so that a thread cannot mistake one call for the next. A share
/// that is begun in an epoch keeps the leader in it; a thread that has begun none must not touch
/// the job.
void Team::Meeting::take_part(std::uint32_t me) {
  std::uint64_t heard = 0;  // no epoch
  for (;;) {
    const std::uint64_t before = heard;
    wait_until([&] { return (heard = call.word.load(std::memory_order_acquire)) != before; });
    if (members_of(heard) == kStop) break;
    if (me < members_of(heard)) do_share(epoch_of(heard), me, members_of(heard));
  }
  asked.fetch_add(1);
  left.fetch_add(1, std::memory_order_release);
}

/// Unless somebody has begun it.
void Team::Meeting::do_share(std::uint64_t now, std::uint32_t share, std::uint32_t members) {
  std::uint64_t before = shares[share].begun.load(std::memory_order_relaxed);
  if (before >= now) return;
  if (!shares[share].begun.compare_exchange_strong(before, now, std::memory_order_acq_rel)) return;
  const Job& job = call.job;
  job.work(job.context, job.count * share / members, job.count * (share + 1) / members);
  shares[share].done.store(now, std::memory_order_release);
}

}  // namespace weft
