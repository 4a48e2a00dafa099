/// A few threads that do a long list of short parallel loops together.
///
/// A loop over the batches of a small cloth lasts a microsecond; handing each to the task scheduler
/// would cost more than that. So the threads are asked for once per solve, as oneTBB tasks in the
/// caller's arena, and from then on meet through one atomic word:
///
///     leader:  announces (epoch, members), does its share, waits for the others' shares
///     member:  waits for a new epoch; if it is among the members, does its share and counts itself
///
/// Nobody is waited for who has not come: a task that the scheduler never starts, or starts late,
/// is simply no member yet. Shares depend on the members present; results must not.
#pragma once

#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace weft {

class Team {
 public:
  /// Asks for up to `threads` threads, this one included; at most what the arena has.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// work(i) for i in [0, count), in shares of consecutive i; returns when all are done.
  template <class Work>
  void for_each(std::size_t count, Work&& work) {
    const auto share = [](void* context, std::size_t first, std::size_t last) {
      Work& body = *static_cast<std::remove_reference_t<Work>*>(context);
      for (std::size_t i = first; i < last; ++i) body(i);
    };
    run({share, &work, count});
  }

 private:
  struct Job {
    void (*share)(void* context, std::size_t first, std::size_t last) = nullptr;
    void* context = nullptr;
    std::size_t count = 0;
  };

  void run(const Job& job);
  void serve();
  static void do_share(const Job& job, std::uint32_t member, std::uint32_t members);

  static constexpr std::size_t kCacheLine = 64;
  // epoch in the high half, members (leader included) in the low half; kStop as members: go home.
  alignas(kCacheLine) std::atomic<std::uint64_t> call_{0};
  alignas(kCacheLine) std::atomic<std::uint32_t> done_{0};    // members that finished this epoch
  alignas(kCacheLine) std::atomic<std::uint32_t> joined_{0};  // tasks that have started
  Job job_;  // written by the leader between epochs, read by members of the epoch
  std::uint64_t epoch_ = 0;
  bool alone_ = true;
  tbb::task_group tasks_;
};

}  // namespace weft
