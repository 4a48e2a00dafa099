/// A team does every index of a loop exactly once, whoever comes to help.
#include "engine/parallel/team.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/rounding.h"
#include "tests/support/system.h"
#include "tests/support/tasks.h"
#include "tests/support/teams.h"

namespace weft::test::engine_parallel_team {
namespace {

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

constexpr int kNobody = -1;  // no way to round

/// Loops as above; how the second thread rounds, or kNobody if none came.
int rounding_of_helper(Team& team) {
  std::atomic<int> of_helper{kNobody};
  const auto leader = std::this_thread::get_id();
  const auto start = std::chrono::steady_clock::now();
  while (of_helper == kNobody &&
         std::chrono::steady_clock::now() - start < std::chrono::seconds(30)) {
    team.for_each(2, [&](std::size_t) {
      if (std::this_thread::get_id() != leader) of_helper = rounding();
    });
  }
  return of_helper;
}

TEST_CASE("who helps rounds as its leader does, from team to team") {
  in_arena(2, [] {
    for (const int wanted : {FE_UPWARD, FE_TONEAREST, FE_DOWNWARD}) {
      const int before = std::fegetround();
      int of_helper = kNobody;
      std::fesetround(wanted);
      in_team_of_arena(2, [&](Team& team) { of_helper = rounding_of_helper(team); });
      std::fesetround(before);
      if (of_helper == kNobody) {
        MESSAGE("no second thread came within 30 s: not tested");
      } else {
        CHECK(of_helper == wanted);
      }
    }
  });
}

TEST_CASE("every index is done exactly once, few or many, by any team") {
  for (const int slots : {1, 2}) {
    for (const int threads : {1, 2, 3, 300}) {
      CAPTURE(slots);
      CAPTURE(threads);
      in_arena(slots, [&] {
        in_team_of_arena(threads, [](Team& team) {
          for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 64u, 65u, 1000u, 100'000u}) {
            CAPTURE(count);
            CHECK(each_once(done_by(team, count)));
          }
        });
      });
    }
  }
}

TEST_CASE("indices come in ascending order within a share, all in order on one thread") {
  Team alone;
  std::vector<std::size_t> order;
  alone.for_each(1000, [&](std::size_t i) { order.push_back(i); });
  CHECK(order.size() == 1000);
  CHECK(std::ranges::is_sorted(order));
}

TEST_CASE("thousands of loops: what one wrote the next one reads, in whatever thread") {
  in_team_of(2, [](Team& team) {
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

/// The leader would hang here if it waited for shares that nobody has claimed.
TEST_CASE("a leader does the shares of workers that have joined and claim nothing") {
  Team::SharedState shared;
  Team team(4, shared);
  REQUIRE(team.size() == 4);
  for (const std::uint32_t worker : {1u, 2u, 3u}) CHECK(shared.workers.join() == worker);
  CHECK(shared.workers.join() == 0);
  for (const std::size_t count : {1u, 3u, 4u, 1000u}) CHECK(each_once(done_by(team, count)));
  for (int worker = 0; worker < 3; ++worker) shared.workers.leave();
}

TEST_CASE("a worker that comes late to a loop does none of its shares") {
  Team::SharedState shared;
  const Team::SharedState::Loop loop = shared.publish(3);
  CHECK(shared.claim(loop, 1));
  CHECK_FALSE(shared.claim(loop, 1));
  shared.progress[1].value = 2 * loop.number;
  CHECK_FALSE(shared.claim(loop, 1));
  const Team::SharedState::Loop next = shared.publish(3);
  CHECK(shared.claim(next, 1));
  CHECK(shared.claim(next, 2));
  CHECK_FALSE(shared.claim(loop, 2));
}

TEST_CASE("a second thread comes to help, if the arena has one") {
  if (std::thread::hardware_concurrency() < 2) {
    MESSAGE("this machine has one processor: not tested");
    return;
  }
  in_team_of(2, [](Team& team) { CHECK(threads_seen(team) == 2); });
  in_arena(2, [] {
    in_team_of_arena(1, [](Team& team) {
      const auto leader = std::this_thread::get_id();
      for (int loop = 0; loop < 1000; ++loop) {
        team.for_each(2, [&](std::size_t) { CHECK(std::this_thread::get_id() == leader); });
      }
    });
  });
}

TEST_CASE("the processors that a worker may run on stay as they are") {
  const int allowed = processors_allowed();
  REQUIRE(allowed > 0);
  std::atomic<int> changed{0};
  in_team_of(2, [allowed, &changed](Team& team) {
    threads_seen(team);
    for (int loop = 0; loop < 1000; ++loop) {
      team.for_each(2, [&](std::size_t) { changed += processors_allowed() != allowed; });
    }
  });
  CHECK(changed == 0);
}

TEST_CASE("workers wait through a long serial stage, and work on") {
  in_team_of(2, [](Team& team) {
    threads_seen(team);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(each_once(done_by(team, 1000)));
    CHECK(threads_seen(team) == (std::thread::hardware_concurrency() > 1 ? 2u : 1u));
  });
}

TEST_CASE("teams that follow each other with one shared state, or with two in turn") {
  in_arena(2, [] {
    const auto first = std::make_shared<ArenaRun>(), second = std::make_shared<ArenaRun>();
    Team::SharedState shared;
    int failed = 0;
    for (int k = 0; k < 4000; ++k) {
      in_team(2, shared, {}, k < 2000 || k % 2 == 0 ? first : second,
              [&](Team& team) { failed += each_once(done_by(team, 10)) ? 0 : 1; });
    }
    CHECK(failed == 0);
  });
}

TEST_CASE("teams come and go") {
  in_arena(2, [] {
    std::size_t sum = 0;
    for (int k = 0; k < 3000; ++k) {
      in_team_of_arena(2, [&](Team& brief) {
        if (k % 2 == 0) return;  // nothing to do: the helper may not even have come
        sum += done_by(brief, 10).size();
      });
    }
    CHECK(sum == 15'000);
  });
}

TEST_CASE("teams in the tasks of one arena: more of them than it has threads") {
  for (const int slots : {1, 2}) {
    CAPTURE(slots);
    in_arena(slots, [] {
      std::atomic<int> failed{0};
      in_tasks(40, [&failed](std::size_t) {
        in_team_of_arena(2, [&failed](Team& team) {
          for (int loop = 0; loop < 50; ++loop) {
            if (!each_once(done_by(team, 100))) ++failed;
          }
        });
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
      in_team_of(2, [&failed](Team& team) {
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
  in_team_of(2, [](Team& team) {
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
}  // namespace weft::test::engine_parallel_team
