#include "engine/parallel/team.h"

#include <sched.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <new>
#include <thread>
#include <utility>

namespace weft {
namespace {

constexpr std::uint32_t kStop = 0xffu;
constexpr std::uint32_t kClosed = 0xffffffffu;
/// Pauses before the leader begins a share that is not its own: some microseconds.
constexpr int kGrace = 100;
/// Pauses before a waiting thread gives its processor away: some tens of microseconds.
constexpr int kPatience = 2000;
/// Ticks of the processor's clock, about a millisecond. A share that takes so much longer than
/// twice the leader's own is on a thread without a processor.
constexpr std::uint64_t kLost = 3'000'000;
/// Ticks that a task waits at the door at most: 0.2 ms at 3 GHz.
constexpr std::uint64_t kLinger = 600'000;
/// The leader then goes on alone for so many times what it waited, so that lost processors cost no
/// more than this part of the time. Many rounds are judged as one: a processor that is lost for
/// less than half of them is put up with.
constexpr std::uint64_t kAlone = 8;

/// By all teams.
std::atomic<std::uint64_t> tasks_enqueued{0};

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

/// How this thread rounds, and what it does with denormal numbers; as before in the end.
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

Team::Meeting::Call Team::Meeting::Call::from(std::uint64_t word) {
  return {word >> 16, static_cast<std::uint32_t>(word >> 8 & 0xffu),
          static_cast<std::uint32_t>(word & 0xffu)};
}

std::uint64_t Team::Meeting::Call::word() const { return first << 16 | rounds << 8 | members; }

Team::Meeting::Meeting() : door(kClosed) {}

void Team::Meeting::announce(const Call& call) {
  announced.word.store(call.word(), std::memory_order_release);
}

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
  m.rounding = _mm_getcsr();
  m.announce({++m.round, 1, 1});
  m.door.store(0);
  while (m.asked.load() < helpers_ && ask_one()) continue;
}

/// Returns whether there was memory for it; who cannot be asked does not come.
bool Team::ask_one() {
  meeting_->asked.fetch_add(1);
  tasks_enqueued.fetch_add(1, std::memory_order_relaxed);
  try {
    tbb::this_task_arena::enqueue([shared = meeting_] { shared->attend(); });
  } catch (const std::bad_alloc&) {
    meeting_->asked.fetch_sub(1);
    return false;
  }
  return true;
}

/// Closes the door and waits for those who had come in.
Team::~Team() {
  if (helpers_ <= 0) return;
  Meeting& m = *meeting_;
  m.leaders_processor.store(sched_getcpu(), std::memory_order_relaxed);  // it may have moved
  const std::uint32_t came = m.door.exchange(kClosed, std::memory_order_acq_rel);
  m.announce({++m.round, 1, kStop});
  wait_until([&] { return m.left.load(std::memory_order_acquire) == came; });
}

/// How many share the next loop.
std::uint32_t Team::members() {
  if (helpers_ <= 0) return 1;
  if (alone_until_ > 0 && ticks() < alone_until_) return 1;
  alone_until_ = 0;
  return 1 + meeting_->door.load(std::memory_order_relaxed);
}

void Team::run(const Job& job, int rounds) {
  Meeting& m = *meeting_;
  const auto members =
      static_cast<std::uint32_t>(std::min<std::size_t>(this->members(), job.count));
  if (members < 2) return run_alone(job, rounds);
  const Meeting::Call call{m.round + 1, static_cast<std::uint32_t>(rounds), members};
  m.round += call.rounds;
  m.waited = 0;
  m.announced.job = job;
  m.announce(call);
  const std::uint64_t start = ticks();
  for (std::uint64_t round = call.first; round <= m.round; ++round) {
    m.begin(call, 0, round);  // nobody else does
    m.do_share(call, 0, round, true);
  }
  m.wait_as_leader(call, 1, [&] { return m.all_done(call); });
  const std::uint64_t end = ticks(), own = end - start - m.waited;
  if (m.waited > own + kLost) alone_until_ = end + kAlone * m.waited;
}

void Team::run_alone(const Job& job, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    if (job.staged) job.work(job.context, {round, Stage::front}, 0, job.count);
    job.work(job.context, {round, Stage::rest}, 0, job.count);
    if (job.staged) job.work(job.context, {round, Stage::close}, 0, job.count);
  }
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

/// A call is one word so that a thread cannot mistake one for the next. A share that is begun keeps
/// the leader in the call; a thread that has begun none must not touch the job.
void Team::Meeting::take_part(std::uint32_t me) {
  const Rounding as_the_leader(rounding);
  std::uint64_t heard = 0;  // no call
  for (;;) {
    const std::uint64_t before = heard;
    wait_until([&] { return (heard = announced.word.load(std::memory_order_acquire)) != before; });
    const Call call = Call::from(heard);
    if (call.members == kStop) break;
    if (me < call.members) do_rounds(call, me);
  }
  asked.fetch_add(1);
  left.fetch_add(1, std::memory_order_release);
}

/// Unless somebody else has begun them.
void Team::Meeting::do_rounds(const Call& call, std::uint32_t share) {
  for (std::uint64_t round = call.first; round <= call.last(); ++round) {
    wait_until([&] {
      return shares[share].begun.load(std::memory_order_relaxed) >= round ||
             may_begin(call, share, round);
    });
    if (begin(call, share, round)) do_share(call, share, round, false);
  }
}

bool Team::Meeting::is_done(std::uint32_t share, std::uint64_t by) const {
  return shares[share].done.load(std::memory_order_acquire) >= by;
}

bool Team::Meeting::all_done(const Call& call) const {
  std::uint32_t share = 0;
  while (share < call.members && is_done(share, call.last())) ++share;
  return share == call.members;
}

/// The round before is over, as far as this share has to do with it.
bool Team::Meeting::may_begin(const Call& call, std::uint32_t share, std::uint64_t now) const {
  return now == call.first ||
         (is_done(share, now - 1) && (share == 0 || is_done(share - 1, now - 1)));
}

/// Unless somebody has.
bool Team::Meeting::begin(const Call& call, std::uint32_t share, std::uint64_t now) {
  std::uint64_t before = shares[share].begun.load(std::memory_order_relaxed);
  if (before >= now || !may_begin(call, share, now)) return false;
  return shares[share].begun.compare_exchange_strong(before, now, std::memory_order_acq_rel);
}

void Team::Meeting::do_share(const Call& call, std::uint32_t share, std::uint64_t now, bool leads) {
  const Job& job = announced.job;
  const std::size_t first = job.count * share / call.members;
  const std::size_t last = job.count * (share + 1) / call.members;
  const int round = static_cast<int>(now - call.first);
  if (job.staged) {
    job.work(job.context, {round, Stage::front}, first, last);
    shares[share].front.store(now, std::memory_order_release);
  }
  job.work(job.context, {round, Stage::rest}, first, last);
  if (job.staged) {
    if (share + 1 < call.members) wait_for_front(call, share + 1, now, leads);
    job.work(job.context, {round, Stage::close}, first, last);
  }
  shares[share].done.store(now, std::memory_order_release);
}

void Team::Meeting::wait_for_front(const Call& call, std::uint32_t share, std::uint64_t of,
                                   bool leads) {
  const auto ready = [&] { return shares[share].front.load(std::memory_order_acquire) >= of; };
  if (leads)
    wait_as_leader(call, share, ready);
  else
    wait_until(ready);
}

/// It does itself what could have been begun for a while, of the shares from `first` on: those
/// before may need what it is in the middle of. So what it is in the middle of are shares in
/// ascending order, and what the last of them needs is behind it.
template <class Ready>
void Team::Meeting::wait_as_leader(const Call& call, std::uint32_t first, Ready&& ready) {
  if (ready()) return;
  const std::uint64_t start = ticks(), before = waited;
  for (int spins = 0; !spin_until(kGrace, ready); spins = std::min(spins + kGrace, kPatience)) {
    if (!help(call, first) && spins == kPatience) std::this_thread::yield();
  }
  waited = before + (ticks() - start);
}

bool Team::Meeting::help(const Call& call, std::uint32_t first) {
  for (std::uint32_t share = first; share < call.members; ++share) {
    const std::uint64_t begun = shares[share].begun.load(std::memory_order_relaxed);
    const std::uint64_t next = std::max(begun + 1, call.first);
    if (next > call.last() || !begin(call, share, next)) continue;
    do_share(call, share, next, true);
    return true;
  }
  return false;
}

}  // namespace weft
