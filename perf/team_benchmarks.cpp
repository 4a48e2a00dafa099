/// What it costs to start and end a loop on several threads: short loops of weft::Team.
#include <tbb/task_arena.h>

#include <cstdint>
#include <thread>

#include "engine/parallel/crew.h"
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

constexpr int kLoops = 1000;  // that one team does, as in a step

/// A share that takes a while, the same while each time.
void work(std::int64_t length) {
  float x = 1;
  for (std::int64_t i = 0; i < length; ++i) benchmark::DoNotOptimize(x = x * 0.5f + 1);
}

/// Loops of two equal shares of w each. One thread takes 2 w, two ideally w: the rest is what it
/// costs to start and end a loop. `together` says in how many of the loops both threads took part.
void run_loops(benchmark::State& state, int threads) {
  tbb::task_arena arena(threads);
  Team::SharedState shared;
  const auto arena_run = std::make_shared<ArenaRun>();
  std::int64_t together = 0, loops = 0;
  arena.execute([&] {
    for (auto _ : state) {
      in_team(threads, shared, {}, arena_run, [&](Team& team) {
        for (int i = 0; i < kLoops; ++i) {
          std::thread::id by[2];
          team.for_each(2, [&](std::size_t share) {
            by[share] = std::this_thread::get_id();
            work(state.range(0));
          });
          together += by[0] != by[1];
        }
      });
      loops += kLoops;
    }
  });
  using benchmark::Counter;
  state.counters["ns_per_loop"] =
      Counter(kLoops * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["together"] = static_cast<double>(together) / static_cast<double>(loops);
}

}  // namespace

void register_team_benchmarks() {
  for (const int threads : {1, 2}) {
    const std::string number = std::to_string(threads);
    benchmark::RegisterBenchmark(("team_for_each/" + number).c_str(),
                                 [threads](benchmark::State& state) { run_loops(state, threads); })
        ->Arg(0)
        ->Arg(500)
        ->Arg(5000)
        ->UseRealTime();
  }
}

}  // namespace weft::perf
