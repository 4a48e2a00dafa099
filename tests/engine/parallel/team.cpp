/// A team does every index of a loop exactly once, whoever comes to help.
#include "engine/parallel/team.h"

#include <doctest/doctest.h>
#include <sched.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace weft::test {
namespace {

/// In an arena of so many slots.
template <class Work>
void in_arena(int slots, Work&& work) {
  tbb::task_arena arena(slots);
  arena.execute(work);
}

/// How often each index was done, in a loop by a team of so many.
std::vector<int> done_by(Team& team, std::size_t count) {
  std::vector<int> done(count);  // shares do not overlap: no need for atomics
  team.for_each(count, [&](std::size_t i) { ++done[i]; });
  return done;
}

bool each_once(const std::vector<int>& done) {
  return std::ranges::all_of(done, [](int times) { return times == 1; });
}

/// Loops until a second thread has taken part, or some seconds have passed; how many threads did.
std::size_t threads_seen(Team& team) {
  std::atomic<bool> other{false};
  const auto leader = std::this_thread::get_id();
  const auto start = std::chrono::steady_clock::now();
  while (!other && std::chrono::steady_clock::now() - start < std::chrono::seconds(30)) {
    team.for_each(2, [&](std::size_t) {
      if (std::this_thread::get_id() != leader) other = true;
    });
  }
  return other ? 2 : 1;
}

constexpr unsigned kNobody = 1;  // no way to round

/// Loops as above; how the second thread rounds, or kNobody if none came.
unsigned rounding_of_helper(Team& team) {
  std::atomic<unsigned> rounding{kNobody};
  const auto leader = std::this_thread::get_id();
  const auto start = std::chrono::steady_clock::now();
  while (rounding == kNobody &&
         std::chrono::steady_clock::now() - start < std::chrono::seconds(30)) {
    team.for_each(2, [&](std::size_t) {
      if (std::this_thread::get_id() != leader) rounding = _MM_GET_ROUNDING_MODE();
    });
  }
  return rounding;
}

TEST_CASE("who helps rounds as its leader does, from team to team") {
  in_arena(2, [] {
    for (const unsigned rounding : {_MM_ROUND_UP, _MM_ROUND_NEAREST, _MM_ROUND_DOWN}) {
      const unsigned before = _MM_GET_ROUNDING_MODE();
      _MM_SET_ROUNDING_MODE(rounding);
      Team team(2);
      const unsigned of_helper = rounding_of_helper(team);
      _MM_SET_ROUNDING_MODE(before);
      if (of_helper == kNobody) {
        MESSAGE("no second thread came within 30 s: not tested");
      } else {
        CHECK(of_helper == rounding);
      }
    }
  });
}

TEST_CASE("every index is done exactly once, few or many, by any team") {
  for (const int slots : {1, 2}) {
    for (const int threads : {0, 1, 2, 3, 300}) {
      CAPTURE(slots);
      CAPTURE(threads);
      in_arena(slots, [&] {
        Team team(threads);
        for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 64u, 65u, 1000u, 100'000u}) {
          CAPTURE(count);
          REQUIRE(each_once(done_by(team, count)));
        }
      });
    }
  }
}

TEST_CASE("indices come in ascending order within a share, all in order on one thread") {
  in_arena(1, [] {
    Team team(8);
    std::vector<std::size_t> order;
    team.for_each(1000, [&](std::size_t i) { order.push_back(i); });
    CHECK(order.size() == 1000);
    CHECK(std::ranges::is_sorted(order));
  });
}

TEST_CASE("thousands of loops: what one wrote the next one reads, in whatever thread") {
  in_arena(2, [] {
    Team team(2);
    constexpr std::size_t kCount = 64;
    constexpr int kLoops = 20'000;
    std::vector<int> here(kCount), there(kCount);
    for (int loop = 0; loop < kLoops; ++loop) {
      team.for_each(kCount, [&](std::size_t i) { there[i] = here[kCount - 1 - i] + 1; });
      std::swap(here, there);
    }
    CHECK(std::ranges::all_of(here, [](int value) { return value == kLoops; }));
  });
}

/// A row of cells whose halves depend on each other within a cell, and across the seam with the
/// next cell.
struct Row {
  std::vector<std::uint64_t> left, right;
  explicit Row(std::size_t cells) : left(cells, 1), right(cells, 2) {}

  void mix(std::size_t cell, int round) {
    left[cell] = 3 * left[cell] + right[cell] + static_cast<std::uint64_t>(round);
    right[cell] = 5 * right[cell] + left[cell];
  }
  void sew(std::size_t cell) {
    right[cell] = 7 * right[cell] + left[cell + 1];
    left[cell + 1] = 11 * left[cell + 1] + right[cell];
  }
  void do_part(const Team::Part& part, std::size_t first, std::size_t last) {
    if (part.stage == Team::Stage::front) mix(first, part.round);
    for (std::size_t i = first + 1; part.stage == Team::Stage::rest && i < last; ++i) {
      mix(i, part.round);
      sew(i - 1);
    }
    if (part.stage == Team::Stage::close && last < left.size()) sew(last - 1);
  }
};

TEST_CASE("rounds in which shares meet their neighbours only end as if all had met") {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 8);
  constexpr int kRounds = 2 * Team::kMostRounds;
  std::atomic<int> shared{0};  // stages done by helpers
  for (const std::size_t cells : {1u, 2u, 3u, 4u, 9u, 50u}) {
    CAPTURE(cells);
    Row expected(cells);
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < cells; ++i) expected.mix(i, round % Team::kMostRounds);
      for (std::size_t i = 0; i + 1 < cells; ++i) expected.sew(i);
    }
    for (int run = 0; run < 40; ++run) {
      const int threads = 1 + run % 6;
      CAPTURE(threads);
      in_arena(threads, [&] {
        const auto leader = std::this_thread::get_id();
        Team team(threads);
        if (threads > 1 && run < 20) threads_seen(team);
        Row row(cells);
        for (int half = 0; half < 2; ++half) {
          team.for_each_share_in_rounds(
              cells, Team::kMostRounds,
              [&](const Team::Part& part, std::size_t first, std::size_t last) {
                row.do_part(part, first, last);
                shared += std::this_thread::get_id() != leader;
              });
        }
        REQUIRE(row.left == expected.left);
        REQUIRE(row.right == expected.right);
        REQUIRE(each_once(done_by(team, 10)));
      });
    }
  }
  if (std::thread::hardware_concurrency() > 1) CHECK(shared > 1000);
}

/// What a leader would hang in if it helped with a share in front of the one it is doing: share 1,
/// whose next round needs share 2, which needs share 3, all of them late.
TEST_CASE("a leader that helps the late does not wait for itself") {
  struct Late {
    std::shared_ptr<Team::Meeting> meeting = Team::make_meeting();
    std::atomic<bool> over{false};
    int parts = 0;
    void do_part(const Team::Part& part, std::size_t first) {
      ++parts;
      const bool second_share = first == 2 && part.round == 0;
      if (second_share && part.stage == Team::Stage::rest) meeting->shares[1].done = 1;
    }
  };
  const auto late = std::make_shared<Late>();  // outlives a thread that hangs
  late->meeting->announced.job = {
      [](void* context, const Team::Part& part, std::size_t first, std::size_t) noexcept {
        static_cast<Late*>(context)->do_part(part, first);
      },
      late.get(), 4, true};
  late->meeting->shares[1].begun = late->meeting->shares[1].front = 1;  // somebody is at it
  std::thread([late] {
    const Team::Meeting::Call call{1, 2, 4};
    for (const std::uint64_t round : {1u, 2u}) late->meeting->do_share(call, 0, round, true);
    late->over = true;
  }).detach();
  for (int i = 0; i < 5000 && !late->over; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  REQUIRE(late->over);
  CHECK(late->parts >=
        3 * 5);  // of shares 0 and 2 in round 1, of share 0 and fronts behind it in 2
}

TEST_CASE("a second thread comes to help, if the arena has one") {
  if (std::thread::hardware_concurrency() < 2) {
    MESSAGE("this machine has one processor: not tested");
    return;
  }
  in_arena(2, [] {
    Team team(2);
    CHECK(threads_seen(team) == 2);
  });
  in_arena(2, [] {
    Team team(1);
    const auto leader = std::this_thread::get_id();
    for (int loop = 0; loop < 1000; ++loop) {
      team.for_each(2, [&](std::size_t) { REQUIRE(std::this_thread::get_id() == leader); });
    }
  });
}

/// Of the thread that asks; -1 if that cannot be known.
int processors_allowed() {
  cpu_set_t allowed;
  return sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : -1;
}

TEST_CASE("whoever was sent to another processor may still use them all") {
  const int allowed = processors_allowed();
  std::atomic<int> changed{0};
  for (int i = 0; i < 20; ++i) {
    in_arena(2, [allowed, &changed] {
      Team team(2);
      for (int loop = 0; loop < 1000; ++loop) {
        team.for_each(2, [&](std::size_t) {
          if (loop % 100 == 0 && processors_allowed() != allowed) ++changed;
        });
      }
    });
  }
  CHECK(changed == 0);
}

TEST_CASE("teams that follow each other at one meeting, or at two in turn") {
  in_arena(2, [] {
    const auto meeting = Team::make_meeting(), other = Team::make_meeting();
    for (int team = 0; team < 4000; ++team) {
      Team one(2, team < 2000 || team % 2 == 0 ? meeting : other);
      REQUIRE(each_once(done_by(one, 10)));
    }
  });
}

TEST_CASE("teams come and go") {
  in_arena(2, [] {
    std::size_t sum = 0;
    for (int team = 0; team < 3000; ++team) {
      Team brief(2);
      if (team % 2 == 0) continue;  // nothing to do: the helper may not even have come
      sum += done_by(brief, 10).size();
    }
    CHECK(sum == 15'000);
  });
}

TEST_CASE("teams in the tasks of one arena: more of them than it has threads") {
  for (const int slots : {1, 2}) {
    CAPTURE(slots);
    in_arena(slots, [] {
      std::atomic<int> failed{0};
      tbb::parallel_for(0, 40, [&](int) {
        Team team(2);
        for (int loop = 0; loop < 50; ++loop) {
          if (!each_once(done_by(team, 100))) ++failed;
        }
      });
      CHECK(failed == 0);
    });
  }
}

TEST_CASE("more threads than processors: leaders wait for no one who has lost his") {
  std::atomic<int> failed{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < 6; ++k) {
    threads.emplace_back([&failed] {
      in_arena(2, [&failed] {
        Team team(2);
        for (int loop = 0; loop < 500; ++loop) {
          if (!each_once(done_by(team, 40))) ++failed;
        }
      });
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(failed == 0);
}

TEST_CASE("a share that takes long is waited for") {
  in_arena(2, [] {
    Team team(2);
    threads_seen(team);
    std::vector<int> done(2);
    team.for_each(2, [&](std::size_t i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ++done[i];
    });
    CHECK(each_once(done));
    CHECK(each_once(done_by(team, 1000)));
  });
}

}  // namespace
}  // namespace weft::test
