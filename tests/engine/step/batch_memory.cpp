/// A batch allocates nothing once warm; cloths that find no memory fail each for itself.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <new>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"
#include "tests/support/job_systems.h"

namespace weft::test::engine_step_batch_memory {
namespace {

/// Small ones with and without contacts, and one that is worth two threads.
std::vector<Cloth> clothes() {
  std::vector<Cloth> all;
  for (int k = 0; k < 20; ++k) all.push_back(cloth_of(scene_of("hang", 7), {}));
  for (int k = 0; k < 5; ++k) all.push_back(cloth_of(scene_of("hang_sphere", 7), {}));
  all.push_back(cloth_of(scene_of("hang", 45), {}));
  return all;
}

std::vector<ClothStep> steps_of(std::vector<Cloth>& cloths) {
  std::vector<ClothStep> steps;
  for (Cloth& cloth : cloths) steps.push_back({.cloth = &cloth, .dt = 0.005});
  return steps;
}

/// Of the second of two equal motions.
std::size_t allocations_when_warm(const JobSystem& jobs) {
  std::vector<Cloth> cloths = clothes();
  std::vector<Cloth> start;
  for (const Cloth& cloth : cloths) start.push_back(cloth.clone());
  std::vector<ClothStep> steps = steps_of(cloths);
  std::size_t before = 0;
  for (int motion = 0; motion < 2; ++motion) {
    for (std::size_t i = 0; i < cloths.size(); ++i) CHECK(cloths[i].copy_state(start[i]));
    before = allocations();
    for (int k = 0; k < 60; ++k) step_all(steps, jobs);
  }
  const std::size_t after = allocations();
  for (const ClothStep& step : steps) CHECK(step.result);
  return after - before;
}

TEST_CASE("a warm batch allocates nothing") {
  CHECK(allocations_when_warm({}) == 0);
  tbb::task_arena arena(2);
  arena.execute([] { CHECK(allocations_when_warm({}) == 0); });
  OddHost host = at_once(2);
  CHECK(allocations_when_warm(host.jobs()) == 0);
}

/// What comes first wants memory in its first step; the cloth after it wants none.
TEST_CASE("a cloth that finds no memory stays as it was and says so; the others go on") {
  Cloth needy = cloth_of(scene_of("sphere_drop", 7), paper_settings());
  Cloth content = cloth_of(scene_of("hang", 7), paper_settings());
  const std::uint64_t start = needy.state_hash();
  ClothStep steps[]{{&needy, 0.01}, {&content, 0.01}};
  int failures = 0;
  for (; failures < 100; ++failures) {
    {
      const FailingAllocations failing(static_cast<std::size_t>(failures));
      step_all(steps);
    }
    CHECK(steps[1].result);
    if (steps[0].result) break;
    CHECK(steps[0].result.error() == "out of memory");
    CHECK(needy.state_hash() == start);
  }
  CHECK(failures > 0);
  Cloth expected = cloth_of(scene_of("sphere_drop", 7), paper_settings());
  step(expected, 0.01);
  CHECK(needy.state_hash() == expected.state_hash());
}

TEST_CASE("a step that finds no memory in a job of the host throws in the thread that called it") {
  OddHost host = at_once(2);  // in this thread, whose allocations fail
  Cloth cloth = cloth_of(scene_of("sphere_drop", 46), paper_settings());
  REQUIRE(cloth.particle_count() > 2000);
  const std::uint64_t start = cloth.state_hash();
  int failures = 0;
  for (bool done = false; !done;) {
    try {
      const FailingAllocations failing(static_cast<std::size_t>(failures));
      done = static_cast<bool>(cloth.step(0.01, host.jobs()));
    } catch (const std::bad_alloc&) {
      ++failures;
      REQUIRE(cloth.state_hash() == start);
    }
    REQUIRE(failures < 1000);
  }
  CHECK(failures > 0);
}

}  // namespace
}  // namespace weft::test::engine_step_batch_memory
