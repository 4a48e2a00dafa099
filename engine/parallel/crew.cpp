#include "engine/parallel/crew.h"

#include <algorithm>

#include "engine/parallel/rounding.h"
#include "engine/parallel/waiting.h"

namespace weft {

int threads_of(const JobSystem& jobs) {
  if (jobs.threads == nullptr) return threads_of_arena();
  return std::clamp(jobs.threads(jobs.host), 1, Team::kMaxSize);
}

void Crew::work(Pieces& pieces, const JobSystem& jobs, const std::shared_ptr<ArenaRun>& arena) {
  const bool has_threads = jobs.run != nullptr || arena != nullptr;
  Crew crew(pieces, has_threads ? threads_of(jobs) : 1);
  const Job job{[](void* context) noexcept { static_cast<Crew*>(context)->take_part(); }, &crew};
  if (crew.wanted_ > 1 && jobs.run != nullptr) jobs.run(jobs.host, job, crew.wanted_);
  if (crew.wanted_ > 1 && jobs.run == nullptr) return ArenaRun::run(arena, job, crew.wanted_);
  crew.take_part();  // does the rest
}

Crew::Crew(Pieces& pieces, int threads)
    : pieces_(pieces), threads_(threads), rounding_(Rounding::of_this_thread()) {
  std::size_t large = 0;
  for (std::size_t piece = 0; piece < pieces.count(); ++piece) {
    if (!pieces.is_due(piece)) continue;
    const int worth = worth_of(piece);
    wanted_ = std::min(wanted_ + worth, threads);
    large += worth > 1 ? 1 : 0;
  }
  unopened_ = large;
  if (large == 0) next_ = pieces.count();
}

int Crew::worth_of(std::size_t piece) const { return std::min(pieces_.threads(piece), threads_); }

void Crew::take_part() {
  const std::size_t me = comers_.fetch_add(1);
  if (me >= open_.size()) return;
  const Rounding as_the_caller(rounding_);
  for (std::size_t piece = 0; take(piece);) lead(piece, open_[me]);
  help_others();
}

/// Large pieces first, each in the order of the pieces.
bool Crew::take(std::size_t& piece) {
  const std::size_t count = pieces_.count();
  for (;;) {
    const std::size_t next = next_.fetch_add(1);
    if (next >= 2 * count) return false;
    piece = next % count;
    const bool is_large = worth_of(piece) > 1;
    if (is_large == (next < count) && pieces_.is_due(piece)) return true;
  }
}

void Crew::lead(std::size_t piece, std::atomic<Team::SharedState*>& open) {
  const int worth = worth_of(piece);
  if (worth == 1) {
    Team alone;
    return pieces_.lead(piece, alone);
  }
  Team::SharedState& shared = pieces_.shared(piece);
  Team team(worth, shared);
  open.store(&shared, std::memory_order_release);
  unopened_.fetch_sub(1);
  pieces_.lead(piece, team);
  open.store(nullptr, std::memory_order_relaxed);
}

/// Until there is no team that has room, and none to come.
void Crew::help_others() {
  for (bool helped = true; helped;) {
    wait_until([&] {
      const bool all_opened = unopened_ == 0;
      helped = help_one();
      return helped || all_opened;
    });
  }
}

/// Returns whether there was a team to help.
bool Crew::help_one() {
  return std::ranges::any_of(open_, [](const std::atomic<Team::SharedState*>& open) {
    Team::SharedState* shared = open.load(std::memory_order_acquire);
    return shared != nullptr && shared->help();
  });
}

}  // namespace weft
