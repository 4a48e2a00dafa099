/// What it costs that threads meet: loops of weft::Team over nothing.
#include <tbb/task_arena.h>

#include <atomic>
#include <thread>

#include "engine/team.h"
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

/// Two loops meet the threads twice; a single index would be kept by the leader.
void meet(benchmark::State& state, int threads) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    Team team(threads);
    std::atomic<int> members{0};
    for (int tries = 0; tries < 1000 && members < threads; ++tries) {  // until all have come
      members = 0;
      team.for_each(static_cast<std::size_t>(threads), [&](std::size_t) {
        thread_local int seen = -1;
        if (seen != tries) ++members;
        seen = tries;
      });
      std::this_thread::yield();
    }
    for (auto _ : state) {
      team.for_each(static_cast<std::size_t>(threads),
                    [](std::size_t i) { benchmark::DoNotOptimize(i); });
    }
    state.counters["members"] = members.load();
  });
}

/// Asking for the threads and sending them home: once per step.
void assemble(benchmark::State& state, int threads) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    for (auto _ : state) {
      Team team(threads);
      team.for_each(static_cast<std::size_t>(threads),
                    [](std::size_t i) { benchmark::DoNotOptimize(i); });
    }
  });
}

}  // namespace

void register_team_benchmarks() {
  for (const int threads : {1, 2}) {
    const std::string number = std::to_string(threads);
    benchmark::RegisterBenchmark(("team_for_each/" + number).c_str(), [threads](
                                                                          benchmark::State& state) {
      meet(state, threads);
    })->UseRealTime();
    benchmark::RegisterBenchmark(("team_assemble/" + number).c_str(), [threads](
                                                                          benchmark::State& state) {
      assemble(state, threads);
    })->UseRealTime();
  }
}

}  // namespace weft::perf
