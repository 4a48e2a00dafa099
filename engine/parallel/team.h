/// Threads that carry out the parallel loops of a step together.
///
/// A loop over the batches of a small cloth lasts a microsecond, and handing its parts to a task
/// scheduler would take longer. So threads come to a team once per step (crew.h). From then on
/// loops are started and ended through atomics:
///
///     leader:  publishes a loop, does share 0, waits for the other shares
///     worker:  waits for the next loop, does its share
///
/// To start and end a loop takes two transfers of a cache line between processors.
/// So everything that describes a loop is in one line, and every share has a line of its own.
///
/// The leader never waits for a worker that has not come. Shares are made for the workers that
/// have joined, and after some microseconds the leader does itself what no worker has claimed. It
/// waits for claimed shares alone. Which thread does a share is left to chance, so results must not
/// depend on it.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "engine/parallel/gathering.h"

namespace weft {

inline constexpr std::size_t kStretch = 1024;  // slots that a thread takes at a time

class Team {
 public:
  static constexpr int kMaxSize = 64;
  struct SharedState;

  /// A team of one thread.
  Team() = default;
  /// A team of up to `threads` threads, this one included: others come by shared.help(). The shared
  /// state may be used again by the next team when this one is gone, and may outlive it.
  Team(int threads, SharedState& shared);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// The number of threads if all that were asked for come.
  std::size_t size() const { return static_cast<std::size_t>(std::max(1, 1 + max_workers_)); }
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
  /// work(first, last) of each share of [0, count).
  template <class Work>
  void for_each_share(std::size_t count, Work&& work) {
    const auto share = [](void* context, std::size_t first, std::size_t last) noexcept {
      (*static_cast<std::remove_reference_t<Work>*>(context))(first, last);
    };
    run({share, &work, count});
  }

 private:
  struct LoopWork {
    /// A share that threw would leave others at work on what is gone.
    void (*function)(void* context, std::size_t first, std::size_t last) noexcept = nullptr;
    void* context = nullptr;
    std::size_t count = 0;
  };

  void run(const LoopWork& work);
  std::uint32_t joined() const;

  SharedState* shared_ = nullptr;  // of several threads
  int max_workers_ = 0;
};

/// The data that leader and workers share.
struct Team::SharedState {
  static constexpr std::size_t kCacheLine = 64;
  static constexpr std::uint32_t kEndOfTeam = 0xffu;  // in place of the number of shares
  /// One word, so that a worker cannot mistake one loop for the next. Loops are numbered through,
  /// from team to team.
  struct Loop {
    std::uint64_t number = 0;
    std::uint32_t shares = 0;  // kEndOfTeam: there are no more loops

    static Loop from(std::uint64_t word);
    std::uint64_t word() const;
  };
  struct alignas(kCacheLine) Published {
    std::atomic<std::uint64_t> loop{0};
    LoopWork
        work;  // written by the leader between loops, read by threads that have claimed a share
  };
  /// 2 n - 1 when a share of loop n is claimed, 2 n when it is done.
  struct alignas(kCacheLine) Progress {
    std::atomic<std::uint64_t> value{0};
  };

  Published published;
  alignas(kCacheLine) Gathering workers;  // those that leave have seen the end of the team
  std::uint64_t loops = 0;                // how many the leader has published
  std::array<Progress, kMaxSize> progress;

  /// Works with the team until its end. Returns false where there is none, or where it is complete.
  bool help();

  Loop publish(std::uint32_t shares);
  void work_until_end(std::uint32_t me);
  bool is_done(const Loop& loop, std::uint32_t share) const;
  bool all_done(const Loop& loop) const;
  bool claim(const Loop& loop, std::uint32_t share);
  void do_share(const Loop& loop, std::uint32_t share);
  void claim_and_do(const Loop& loop, std::uint32_t share);
};

}  // namespace weft
