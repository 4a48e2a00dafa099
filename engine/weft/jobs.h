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
/// A default JobSystem is the oneTBB arena that the calling thread is in. A thread that is in no
/// arena, and has never used oneTBB, works alone: weft starts no thread.
/// So does every thread where weft is built without oneTBB (WEFT_TBB=OFF).
/// Results do not depend on which thread runs which job.
#pragma once

namespace weft {

/// A function for the job system to call. A call uses the rounding mode of the thread that steps
/// the cloths, and restores the floating-point state of its own thread.
struct Job {
  void (*function)(void* context) noexcept = nullptr;
  void* context = nullptr;

  void operator()() const noexcept { function(context); }
};

/// The threads of the caller. Set both functions or neither. weft calls them in the thread that
/// steps, and keeps neither of them when the step is over.
struct JobSystem {
  void* host = nullptr;  ///< the argument of the functions
  /// Returns how many threads may run jobs at the same time, the calling one included. weft uses at
  /// most 64.
  int (*threads)(void* host) noexcept = nullptr;
  /// Calls job() `times` times, in any threads, at the same time or one after the other, and
  /// returns when all calls have returned. The calling thread should take part: weft waits here
  /// until the last call has been made.
  ///
  /// All calls are alike. The first one begins the work. Calls that start while there is work left
  /// help; later calls return at once. So no call waits for another one to begin. run may make
  /// fewer calls; the calling thread then does the rest.
  void (*run)(void* host, Job job, int times) noexcept = nullptr;
};

}  // namespace weft
