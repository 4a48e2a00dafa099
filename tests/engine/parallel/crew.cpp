/// A crew does every piece exactly once, whoever runs its jobs, in whatever order.
#include "engine/parallel/crew.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <deque>
#include <string>
#include <thread>

#include "tests/support/job_systems.h"
#include "tests/support/rounding.h"
#include "tests/support/teams.h"

namespace weft::test::engine_parallel_crew {
namespace {

/// Pieces that are loops; each `period`-th is worth several threads, and each third is not due.
class Loops : public Pieces {
 public:
  static constexpr std::size_t kLength = 100;

  Loops(std::size_t count, std::size_t period) : period_(period), done_(count * kLength) {
    for (std::size_t i = 0; i < count; i += period) shared_.emplace_back();
  }
  std::size_t count() const override { return done_.size() / kLength; }
  int threads(std::size_t i) const override { return i % period_ == 0 ? 3 : 1; }
  bool is_due(std::size_t i) const override { return i % 3 != 2; }
  Team::SharedState& shared(std::size_t i) override { return shared_[i / period_]; }
  void lead(std::size_t i, Team& team) noexcept override {
    team.for_each(kLength, [&](std::size_t k) { ++done_[i * kLength + k]; });
  }
  bool are_done() const {
    for (std::size_t k = 0; k < done_.size(); ++k) {
      if (done_[k] != (is_due(k / kLength) ? 1 : 0)) return false;
    }
    return true;
  }

 private:
  std::size_t period_;
  std::vector<int> done_;  // pieces and shares do not overlap: no need for atomics
  std::deque<Team::SharedState> shared_;
};

template <class Work>
void with_loops(Work&& work) {
  for (const std::size_t count : {0u, 1u, 2u, 7u, 300u}) {
    for (const std::size_t period : {1u, 4u, 1000u}) {
      CAPTURE(count);
      CAPTURE(period);
      Loops loops(count, period);
      work(loops);
      CHECK(loops.are_done());
    }
  }
}

TEST_CASE("every piece is done exactly once, by any host's jobs") {
  for (const int threads : {1, 2, 4}) {
    for_each_host(threads, [&](const std::string& name, const JobSystem& jobs) {
      CAPTURE(name);
      CAPTURE(threads);
      with_loops([&](Loops& loops) { Crew::work(loops, jobs, nullptr); });
    });
  }
}

TEST_CASE("and by the tasks of an arena") {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
  for (const int slots : {1, 2, 4}) {
    CAPTURE(slots);
    const auto arena_run = std::make_shared<ArenaRun>();
    in_arena(slots, [&] {
      with_loops([&](Loops& loops) { Crew::work(loops, {}, arena_run); });
      with_loops([&](Loops& loops) { Crew::work(loops, {}, nullptr); });
    });
  }
}

TEST_CASE("what a host says of its threads is not believed beyond what there can be") {
  for (const int said : {-5, 0, 1000}) {
    CAPTURE(said);
    OddHost host = at_once(said);
    CHECK(threads_of(host.jobs()) == std::clamp(said, 1, Team::kMaxSize));
    with_loops([&](Loops& loops) { Crew::work(loops, host.jobs(), nullptr); });
  }
}

TEST_CASE("more calls than were asked for find nothing to do") {
  OddHost eager(4, [](Job job, int times) {
    for (int k = 0; k < 100 * times; ++k) job();
  });
  with_loops([&](Loops& loops) { Crew::work(loops, eager.jobs(), nullptr); });
}

/// Piece 0 is large: it lasts until somebody has helped, or some seconds. Piece 1 is small.
class OneNeedsHelp : public Pieces {
 public:
  std::size_t count() const override { return 2; }
  int threads(std::size_t i) const override { return i == 0 ? 2 : 1; }
  bool is_due(std::size_t) const override { return true; }
  Team::SharedState& shared(std::size_t) override { return shared_; }
  void lead(std::size_t i, Team& team) noexcept override {
    if (i == 1) return;
    const auto leader = std::this_thread::get_id();
    const auto start = std::chrono::steady_clock::now();
    while (!helped_ && std::chrono::steady_clock::now() - start < std::chrono::seconds(30)) {
      team.for_each(2, [&](std::size_t) {
        if (std::this_thread::get_id() == leader) return;
        helper_rounds_ = rounding();
        helped_ = true;
      });
    }
  }
  bool was_helped() const { return helped_; }
  int helper_rounds() const { return helper_rounds_; }

 private:
  Team::SharedState shared_;
  std::atomic<bool> helped_{false};
  std::atomic<int> helper_rounds_{-1};
};

TEST_CASE("who finds no piece left helps with a large one, and rounds as the caller does") {
  Pool pool(2);
  for (const int wanted : {FE_TONEAREST, FE_UPWARD}) {
    OneNeedsHelp pieces;
    const int before = std::fegetround();
    std::fesetround(wanted);
    Crew::work(pieces, pool.jobs(), nullptr);
    std::fesetround(before);
    CHECK(pieces.was_helped());
    CHECK(pieces.helper_rounds() == wanted);
  }
}

TEST_CASE("a thread that ran a job rounds as it did before") {
  int after = -1;
  OddHost host(2, [&after](Job job, int times) {
    std::thread([&] {
      std::fesetround(FE_DOWNWARD);
      for (int k = 0; k < times; ++k) job();
      after = rounding();
    }).join();
  });
  Loops loops(10, 4);
  Crew::work(loops, host.jobs(), nullptr);
  CHECK(after == FE_DOWNWARD);
  CHECK(loops.are_done());
}

}  // namespace
}  // namespace weft::test::engine_parallel_crew
