#include "engine/parallel/team.h"

#include <algorithm>

#include "engine/parallel/waiting.h"

namespace weft {
namespace {

/// Pauses before the leader claims shares that are not its own: some microseconds.
constexpr int kPausesBeforeHelp = 100;

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

Team::Team(int threads, SharedState& shared)
    : shared_(&shared), max_workers_(std::clamp(threads, 1, kMaxSize) - 1) {
  if (max_workers_ == 0) return;
  shared.publish(0);  // the end of the last team is no longer what workers see
  shared.workers.open(static_cast<std::uint32_t>(max_workers_));
}

/// Closes the team and waits until all threads that joined have left.
Team::~Team() {
  if (max_workers_ == 0) return;
  const std::uint32_t came = shared_->workers.close();
  shared_->publish(SharedState::kEndOfTeam);
  shared_->workers.wait_until_left(came);
}

std::uint32_t Team::joined() const { return max_workers_ > 0 ? shared_->workers.joined() : 0; }

void Team::run(const LoopWork& work) {
  const auto shares = static_cast<std::uint32_t>(std::min<std::size_t>(1 + joined(), work.count));
  if (shares < 2) return work.function(work.context, 0, work.count);
  SharedState& s = *shared_;
  s.published.work = work;
  const SharedState::Loop loop = s.publish(shares);
  s.do_share(loop, 0);
  const auto done = [&] { return s.all_done(loop); };
  if (spin_until(kPausesBeforeHelp, done)) return;
  for (std::uint32_t share = 1; share < shares; ++share) s.claim_and_do(loop, share);
  wait_until(done);
}

bool Team::SharedState::help() {
  const std::uint32_t me = workers.join();
  if (me == 0) return false;
  work_until_end(me);
  return true;
}

void Team::SharedState::work_until_end(std::uint32_t me) {
  std::uint64_t seen = 0;  // no loop has this word
  for (;;) {
    const std::uint64_t last = seen;
    wait_until([&] { return (seen = published.loop.load(std::memory_order_acquire)) != last; });
    const Loop loop = Loop::from(seen);
    if (loop.shares == kEndOfTeam) break;
    if (me < loop.shares) claim_and_do(loop, me);
  }
  workers.leave();
}

bool Team::SharedState::is_done(const Loop& loop, std::uint32_t share) const {
  return progress[share].value.load(std::memory_order_acquire) >= 2 * loop.number;
}

bool Team::SharedState::all_done(const Loop& loop) const {
  std::uint32_t share = 1;
  while (share < loop.shares && is_done(loop, share)) ++share;
  return share == loop.shares;
}

/// Returns false if another thread has claimed the share, or if the loop is over. The leader does
/// not leave a loop while a share of it is claimed and not done, so the work stays what it is.
bool Team::SharedState::claim(const Loop& loop, std::uint32_t share) {
  std::uint64_t before = progress[share].value.load(std::memory_order_relaxed);
  const std::uint64_t claimed = 2 * loop.number - 1;
  return before < claimed &&
         progress[share].value.compare_exchange_strong(before, claimed, std::memory_order_acq_rel);
}

void Team::SharedState::do_share(const Loop& loop, std::uint32_t share) {
  const LoopWork& work = published.work;
  work.function(work.context, work.count * share / loop.shares,
                work.count * (share + 1) / loop.shares);
}

void Team::SharedState::claim_and_do(const Loop& loop, std::uint32_t share) {
  if (!claim(loop, share)) return;
  do_share(loop, share);
  progress[share].value.store(2 * loop.number, std::memory_order_release);
}

}  // namespace weft
