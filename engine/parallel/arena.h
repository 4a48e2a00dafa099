/// The oneTBB arena of the calling thread as a job system.
#pragma once

#include <weft/jobs.h>

#include <atomic>
#include <memory>

#include "engine/parallel/gathering.h"

namespace weft {

/// How many threads it has, up to Team::kMaxSize; 1 where the calling thread is in none.
int threads_of_arena();

/// Data that arena and caller share. They outlive a run, since a task may start when that is over:
/// it finds the run closed, and returns at once.
class ArenaRun {
 public:
  /// Calls job() in this thread, and in up to times - 1 others of the arena, if they come before
  /// this thread has done with it. Returns when all calls have returned.
  static void run(const std::shared_ptr<ArenaRun>& shared, Job job, int times);

 private:
  static bool enqueue(const std::shared_ptr<ArenaRun>& shared);
  void start_task();

  Gathering comers_;
  std::atomic<int> pending_{0};  // tasks that have not started
  Job job_;                      // written while it is closed
};

}  // namespace weft
