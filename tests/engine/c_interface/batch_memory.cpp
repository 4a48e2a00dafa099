/// What weft_step_all allocates: a list in its first call, and nothing in later ones.
#include <doctest/doctest.h>
#include <weft/weft_c.h>

#include <vector>

#include "engine/c_interface/scene_arrays.h"
#include "tests/support/c_interface.h"
#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_c_interface_batch_memory {
namespace {

Owned<weft_model> model_in_c(const SceneDescription& scene) {
  const c_interface::SceneArrays arrays = c_interface::arrays_of(scene);
  const weft_scene its = c_interface::scene_of(scene, arrays);
  return made<weft_model>([&](weft_model** out) { return weft_build_model(&its, out); });
}

struct CBatch {
  std::vector<Owned<weft_cloth>> cloths;
  std::vector<weft_batch_step> steps;

  explicit CBatch(std::size_t count) : steps(count, initial(weft_init_batch_step)) {
    const auto model = model_in_c(scene_of("hang", 5));
    for (weft_batch_step& step : steps) {
      cloths.push_back(made<weft_cloth>(
          [&](weft_cloth** out) { return weft_create_cloth(model.get(), nullptr, out); }));
      step.cloth = cloths.back().get();
      step.dt = 0.01;
    }
  }
  /// Of so many steps of the first cloths.
  std::size_t allocations_of(int times, std::size_t count) {
    const std::size_t before = allocations();
    for (int k = 0; k < times; ++k) {
      if (weft_step_all(count, steps.data(), nullptr) != WEFT_OK) return before + 1;
    }
    const std::size_t after = allocations();
    for (std::size_t i = 0; i < count; ++i) CHECK(steps[i].result == WEFT_OK);
    return after - before;
  }
};

TEST_CASE("in C a warm batch allocates nothing, and nothing for fewer cloths") {
  CBatch batch(64);
  CHECK(batch.allocations_of(30, 64) > 0);
  CHECK(batch.allocations_of(30, 64) == 0);
  CHECK(batch.allocations_of(5, 12) == 0);
  CHECK(batch.allocations_of(5, 64) == 0);
}

TEST_CASE("in C a batch that finds no memory for its list steps nothing") {
  CBatch batch(3);
  const std::uint64_t start = weft_state_hash(batch.cloths[0].get());
  {
    const FailingAllocations failing(0);
    CHECK(weft_step_all(3, batch.steps.data(), nullptr) == WEFT_OUT_OF_MEMORY);
  }
  for (const auto& cloth : batch.cloths) CHECK(weft_state_hash(cloth.get()) == start);
  CHECK(batch.allocations_of(1, 3) > 0);
  CHECK(weft_state_hash(batch.cloths[2].get()) != start);
}

}  // namespace
}  // namespace weft::test::engine_c_interface_batch_memory
