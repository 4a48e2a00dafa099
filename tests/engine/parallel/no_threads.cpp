/// weft starts no thread: a process that has one keeps having one. (A test of its own process.)
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/clothes.h"
#include "tests/support/job_systems.h"
#include "tests/support/system.h"

namespace weft::test::engine_parallel_no_threads {
namespace {

/// Steps cloths that are worth several threads, alone and together. Returns how many threads there
/// were then, at most.
std::ptrdiff_t threads_while_stepping(const JobSystem& jobs, int threads) {
  const auto model = model_of(scene_of("hang", 80));
  const Settings settings{.substeps = 4, .threads = threads};
  auto one = Cloth::create(model, settings), other = Cloth::create(model, settings);
  REQUIRE((one && other));
  std::ptrdiff_t most = 0;
  for (int k = 0; k < 5; ++k) {
    CHECK(one.value().step(0.01, jobs));
    ClothStep both[]{{&one.value(), 0.01}, {&other.value(), 0.01}};
    step_all(both, jobs);
    CHECK((both[0].result && both[1].result));
    most = std::max(most, threads_alive());
  }
  return most;
}

TEST_CASE("a thread in no arena works alone, whatever the settings allow") {
  const std::ptrdiff_t before = threads_alive();
  REQUIRE(before > 0);
  for (const int threads : {0, 1, 2}) CHECK(threads_while_stepping({}, threads) == before);
}

TEST_CASE("a host's threads are all that there are") {
  Pool pool(3);
  const std::ptrdiff_t before = threads_alive();
  REQUIRE(before > 0);
  for (const int threads : {0, 1, 2}) {
    CHECK(threads_while_stepping(pool.jobs(), threads) == before);
  }
}

}  // namespace
}  // namespace weft::test::engine_parallel_no_threads
