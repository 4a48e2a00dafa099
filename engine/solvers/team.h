/// A few threads that do a long list of short parallel loops together.
///
/// A loop over the batches of a small cloth lasts a microsecond; handing each to the task scheduler
/// would cost more than that. So the threads are asked for once per step, as oneTBB tasks in the
/// caller's arena, and from then on meet through atomics:
///
///     leader:  announces (epoch, members), does its share, waits for the others'
///     member:  waits for a new epoch, does its share
///
/// A meeting costs what it takes a cache line to cross between processors, twice; so everything
/// that a call says is in one line, and nobody touches the lines of another without need.
///
/// A task that has done its part stays at the door for as long as that took, 0.2 ms at most: the
/// next step may follow at once, and a processor that fell asleep takes tens of microseconds to
/// wake. It goes when tasks are enqueued for another team. One that finds itself on the leader's
/// processor is sent to another.
///
/// Nobody is waited for who has not come: a task that the scheduler never starts, or starts late,
/// is simply no member yet, and the leader does itself what a member has not begun after a while.
/// If a share that was begun keeps it waiting for long, beside the time of its own, its thread has
/// lost its processor: the leader goes on alone for a while. Who does a share is left to chance;
/// results must not depend on it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace weft {

class Team {
 public:
  static constexpr int kMostMembers = 64;
  struct Meeting;

  /// Asks for up to `threads` threads, this one included; at most what the arena has. A meeting may
  /// be used again by the next team, when this one is gone.
  explicit Team(int threads, std::shared_ptr<Meeting> meeting = make_meeting());
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  static std::shared_ptr<Meeting> make_meeting();

  /// Threads, if all that were asked for come.
  std::size_t size() const { return static_cast<std::size_t>(helpers_ > 0 ? helpers_ + 1 : 1); }
  /// work(i) for i in [0, count), in shares of consecutive i; returns when all are done.
  template <class Work>
  void for_each(std::size_t count, Work&& work) {
    for_each_share(count, [&work](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) work(i);
    });
  }
  /// work(first, last) of each share.
  template <class Work>
  void for_each_share(std::size_t count, Work&& work) {
    const auto share = [](void* context, std::size_t first, std::size_t last) {
      (*static_cast<std::remove_reference_t<Work>*>(context))(first, last);
    };
    run({share, &work, count});
  }

 private:
  struct Job {
    void (*work)(void* context, std::size_t first, std::size_t last) = nullptr;
    void* context = nullptr;
    std::size_t count = 0;
  };

  void run(const Job& job);
  std::uint32_t members();
  void finish_share(std::uint32_t share, std::uint32_t members);

  std::shared_ptr<Meeting> meeting_;
  int helpers_ = 0;
  std::uint64_t alone_until_ = 0;  // on the processor's clock; 0: not alone
};

/// Where leader and members meet. It outlives the team, since a task may start when the team is
/// gone: it finds the door closed.
struct Team::Meeting {
  static constexpr std::size_t kCacheLine = 64;
  /// epoch << 16 | members, leader included; kStop as members: go home.
  struct alignas(kCacheLine) Call {
    std::atomic<std::uint64_t> word{0};
    Job job;  // written by the leader between epochs, read by whoever has begun a share
  };
  /// The last epoch in which somebody began, and finished, the share of a member.
  struct Share {
    alignas(kCacheLine) std::atomic<std::uint64_t> begun{0};
    alignas(kCacheLine) std::atomic<std::uint64_t> done{0};
  };

  Call call;
  alignas(kCacheLine) std::atomic<std::uint32_t> door;  // kClosed, or how many have come in
  std::atomic<std::uint32_t> seats{0};                  // how many may
  std::atomic<int> leaders_processor{-1};
  std::atomic<std::uint32_t> left{0};  // of those who came in
  std::atomic<int> asked{0};           // tasks not started, or at the door
  std::array<Share, kMostMembers> shares;
  std::uint64_t epoch = 0;

  Meeting();
  void attend();
  std::uint32_t come_in(std::uint64_t patience);
  std::uint32_t enter();
  void take_part(std::uint32_t me);
  void do_share(std::uint64_t epoch, std::uint32_t share, std::uint32_t members);
};

}  // namespace weft
