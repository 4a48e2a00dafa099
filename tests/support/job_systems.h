/// Job systems of hosts, from usual ones to odd ones.
#pragma once

#include <weft/jobs.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace weft::test {

/// As games have: threads of its own and a queue. Who waits for its jobs takes part.
class Pool {
 public:
  explicit Pool(int threads);  // the calling one included
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  JobSystem jobs();

 private:
  struct Call {
    Job job;
    int* left;  // of the run that it belongs to
  };
  void run(Job job, int times);
  void work_until_closed();
  void make(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Call> queue_;
  bool closed_ = false;
  std::vector<std::thread> threads_;
};

/// A JobSystem that says it has so many threads, and makes its calls as `run` does.
class OddHost {
 public:
  using Run = std::function<void(Job, int)>;
  OddHost(int threads, Run run) : threads_(threads), run_(std::move(run)) {}
  JobSystem jobs();

 private:
  int threads_;
  Run run_;
};

/// All calls in the calling thread, one after the other.
OddHost at_once(int threads);
/// Each call in a thread of its own, one after the other, none in the calling one.
OddHost in_turns(int threads);
/// All at the same time in threads of their own, the last ones first, none in the calling one.
OddHost backwards(int threads);
/// Fewer calls than were asked for: none at all.
OddHost without_calls(int threads);

/// f(name, jobs) for each of the above, of so many threads.
template <class F>
void for_each_host(int threads, F&& f) {
  Pool pool(threads);
  OddHost first = at_once(threads), second = in_turns(threads), third = backwards(threads),
          fourth = without_calls(threads);
  f("pool", pool.jobs());
  f("at once", first.jobs());
  f("in turns", second.jobs());
  f("backwards", third.jobs());
  f("without calls", fourth.jobs());
}

}  // namespace weft::test
