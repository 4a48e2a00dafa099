/// The threads of a program that has a job system of its own. Part of weft.h.
///
///   weft::JobSystem jobs;
///   jobs.host = &pool;
///   jobs.threads = [](void* host) noexcept { return static_cast<Pool*>(host)->threads(); };
///   jobs.run = [](void* host, weft::Job job, int times) noexcept {
///     static_cast<Pool*>(host)->run_and_wait(times, [job] { job(); });
///   };
///   auto report = cloth.step(dt, jobs);  // or step_all(cloths, jobs)
///
/// A default JobSystem is the oneTBB arena that the calling thread is in. A thread that is in none,
/// and has never used oneTBB, works alone: weft starts no thread.
///
/// Results do not depend on who runs what.
#pragma once

namespace weft {

/// What a job system is to call. A call rounds as the thread does that steps the cloths, and leaves
/// the floating-point state of its own thread as it was.
struct Job {
  void (*function)(void* context) noexcept = nullptr;
  void* context = nullptr;

  void operator()() const noexcept { function(context); }
};

/// Both functions or neither. weft calls them in the thread that steps, and keeps nothing of them
/// when the step is over.
struct JobSystem {
  void* host = nullptr;  ///< what the functions are called with
  /// How many threads may run jobs at the same time, the calling one included; beyond 64 they are
  /// not used.
  int (*threads)(void* host) noexcept = nullptr;
  /// Calls job() so many times, in any threads, at the same time or one after the other, and
  /// returns when all calls have returned. The calling thread should take part: weft waits here
  /// until the last call has been made.
  ///
  /// All calls are alike. The first one begins to work, those that come while there is work help,
  /// and those that come later return at once. So no call waits for another one to begin, and what
  /// is left when run returns (it may have made fewer calls) the calling thread does alone.
  void (*run)(void* host, Job job, int times) noexcept = nullptr;
};

}  // namespace weft
