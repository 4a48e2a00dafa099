#include "engine/parallel/arena.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <new>

#include "engine/parallel/team.h"

namespace weft {

int threads_of_arena() {
  if (tbb::this_task_arena::current_thread_index() < 0) return 1;
  return std::clamp(tbb::this_task_arena::max_concurrency(), 1, Team::kMaxSize);
}

/// Tasks are enqueued, not spawned into a task_group: a thread of the arena that had just run out
/// of work overlooked spawned tasks for over a millisecond (oneTBB 2021.8), while enqueued ones
/// start within 10 to 30 microseconds. Tasks of an earlier run that have not started serve this
/// one. Either such a task sees that the run is open, or it no longer counts as pending here: the
/// order of these four accesses is sequentially consistent.
void ArenaRun::run(const std::shared_ptr<ArenaRun>& shared, Job job, int times) {
  ArenaRun& s = *shared;
  s.job_ = job;
  s.comers_.open(static_cast<std::uint32_t>(times - 1));
  while (s.pending_.load() < times - 1 && enqueue(shared)) continue;
  job();
  s.comers_.wait_until_left(s.comers_.close());
}

/// Returns whether there was memory for the task. A thread that cannot be asked does not come.
bool ArenaRun::enqueue(const std::shared_ptr<ArenaRun>& shared) {
  shared->pending_.fetch_add(1);
  try {
    tbb::this_task_arena::enqueue([shared] { shared->start_task(); });
  } catch (const std::bad_alloc&) {
    shared->pending_.fetch_sub(1);
    return false;
  }
  return true;
}

void ArenaRun::start_task() {
  pending_.fetch_sub(1);
  if (comers_.join() == 0) return;
  job_();
  comers_.leave();
}

}  // namespace weft
