/// A few threads that do a long list of short parallel loops together.
///
/// A loop over the batches of a small cloth lasts a microsecond; handing each to the task scheduler
/// would cost more than that. So the threads are asked for once per step, as oneTBB tasks in the
/// caller's arena, and from then on meet through atomics:
///
///     leader:  announces a call (rounds, members), does its share of each round, waits for others
///     member:  waits for a new call, does its share of each round
///
/// A meeting costs what it takes a cache line to cross between processors, twice; so everything
/// that a call says is in one line, and nobody touches the lines of another without need.
///
/// A task that has done its part keeps waiting for as long as that took, about 0.2 ms at most: the
/// next step may follow at once, and a processor that fell asleep takes tens of microseconds to
/// wake. It goes when tasks are enqueued for another team. One that finds itself on the leader's
/// processor is sent to another.
///
/// Rounds of one loop are announced at once where a share needs no more than its neighbours: it
/// then meets these alone, when it comes to what they share.
///
/// The leader never waits for a task that has not started: one that the scheduler never starts, or
/// starts late, is no member yet, and after a while the leader does itself the shares that a member
/// has not begun. If one that was begun takes long, compared with the leader's own, its thread has
/// lost its processor: the leader works alone for a while. Which thread does a share is left to
/// chance; results must not depend on it.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace weft {

inline constexpr std::size_t kStretch = 1024;  // slots that a thread takes at a time

class Team {
 public:
  static constexpr int kMostMembers = 64;
  static constexpr int kMostRounds = 240;
  struct Meeting;
  /// Of a share in a round, one after the other. The share before it has closed the round before
  /// when it begins; the front of the share behind it is done when it closes.
  enum class Stage : std::uint8_t { front, rest, close };
  struct Part {
    int round = 0;
    Stage stage = Stage::rest;
  };

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
  /// work(first, last) over [0, count), `part` at a time.
  template <class Work>
  void for_each_part(std::size_t count, std::size_t part, Work&& work) {
    for_each((count + part - 1) / part,
             [&](std::size_t i) { work(i * part, std::min(count, (i + 1) * part)); });
  }
  /// work(first, last) of each share.
  template <class Work>
  void for_each_share(std::size_t count, Work&& work) {
    const auto share = [](void* context, const Part&, std::size_t first,
                          std::size_t last) noexcept {
      (*static_cast<std::remove_reference_t<Work>*>(context))(first, last);
    };
    run({share, &work, count}, 1);
  }
  /// work(part, first, last) of each share, all stages in each of 1 to kMostRounds rounds. Shares
  /// are the same in all of them, and none is empty.
  template <class Work>
  void for_each_share_in_rounds(std::size_t count, int rounds, Work&& work) {
    const auto share = [](void* context, const Part& part, std::size_t first,
                          std::size_t last) noexcept {
      (*static_cast<std::remove_reference_t<Work>*>(context))(part, first, last);
    };
    run({share, &work, count, true}, rounds);
  }

 private:
  struct Job {
    /// Who throws would leave others at work with what is gone.
    void (*work)(void* context, const Part& part, std::size_t first,
                 std::size_t last) noexcept = nullptr;
    void* context = nullptr;
    std::size_t count = 0;
    bool staged = false;  // or all of it as rest
  };

  void run(const Job& job, int rounds);
  bool ask_one();
  void run_alone(const Job& job, int rounds);
  std::uint32_t members();

  std::shared_ptr<Meeting> meeting_;
  int helpers_ = 0;
  std::uint64_t alone_until_ = 0;  // on the processor's clock; 0: not alone
};

/// Where leader and members meet. It outlives the team, since a task may start when the team is
/// gone: it finds the door closed.
struct Team::Meeting {
  static constexpr std::size_t kCacheLine = 64;
  /// What is announced: rounds are numbered through, from meeting to meeting.
  struct Call {
    std::uint64_t first = 0;  // round
    std::uint32_t rounds = 0;
    std::uint32_t members = 0;  // leader included; kStop: go home

    static Call from(std::uint64_t word);
    std::uint64_t word() const;
    std::uint64_t last() const { return first + rounds - 1; }
  };
  struct alignas(kCacheLine) Announced {
    std::atomic<std::uint64_t> word{0};
    Job job;  // written by the leader between calls, read by whoever has begun a share
  };
  /// The last round in which somebody began, did the front of, and finished the share of a member.
  struct Share {
    alignas(kCacheLine) std::atomic<std::uint64_t> begun{0};
    alignas(kCacheLine) std::atomic<std::uint64_t> front{0};
    std::atomic<std::uint64_t> done{0};
  };

  Announced announced;
  alignas(kCacheLine) std::atomic<std::uint32_t> door;  // kClosed, or how many have come in
  std::atomic<std::uint32_t> seats{0};                  // how many may
  std::atomic<int> leaders_processor{-1};
  std::atomic<std::uint32_t> left{0};  // of those who came in
  std::atomic<int> asked{0};           // tasks not started, or at the door
  std::uint32_t rounding = 0;          // of the leader (MXCSR); written while the door is closed
  std::array<Share, kMostMembers> shares;
  std::uint64_t round = 0;   // the last that was announced
  std::uint64_t waited = 0;  // by the leader, in this call; ticks

  Meeting();
  void announce(const Call& call);
  void attend();
  std::uint32_t come_in(std::uint64_t patience);
  std::uint32_t enter();
  void take_part(std::uint32_t me);
  void do_rounds(const Call& call, std::uint32_t share);
  bool is_done(std::uint32_t share, std::uint64_t by) const;
  bool all_done(const Call& call) const;
  bool may_begin(const Call& call, std::uint32_t share, std::uint64_t now) const;
  bool begin(const Call& call, std::uint32_t share, std::uint64_t now);
  void do_share(const Call& call, std::uint32_t share, std::uint64_t now, bool leads);
  void wait_for_front(const Call& call, std::uint32_t share, std::uint64_t of, bool leads);
  template <class Ready>
  void wait_as_leader(const Call& call, std::uint32_t first, Ready&& ready);
  bool help(const Call& call, std::uint32_t first);
};

}  // namespace weft
