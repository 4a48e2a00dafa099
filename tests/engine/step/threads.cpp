/// A Model may be shared by any number of Cloths and threads; a step takes as many as it may.
#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <thread>

#include "engine/isa.h"
#include "engine/step/step_in_team.h"
#include "tests/support/clothes.h"
#include "tests/support/tasks.h"

namespace weft::test::engine_step_threads {
namespace {

TEST_CASE("cloths of one model, run in two threads at once, agree bit for bit") {
  const Backend backend = each_backend();
  for (const char* name : {"hang", "sphere_drop"}) {
    CAPTURE(std::string(name));
    const auto model = model_of(scene_of(name, 10));
    Settings settings = on(backend);
    settings.velocity_correction = true;
    auto alone = Cloth::create(model, settings);
    auto left = Cloth::create(model, settings);
    auto right = Cloth::create(model, settings);
    REQUIRE((alone && left && right));
    const auto run_200 = [](Cloth& cloth) {
      for (int k = 0; k < 200; ++k) (void)cloth.step(0.01);
    };
    run_200(alone.value());
    std::thread first(run_200, std::ref(left.value()));
    std::thread second(run_200, std::ref(right.value()));
    first.join();
    second.join();
    CHECK(left.value().state_hash() == alone.value().state_hash());
    CHECK(right.value().state_hash() == alone.value().state_hash());
  }
}

TEST_CASE("cloths of one model, made and run by the tasks of one arena, agree bit for bit") {
  const auto model = model_of(scene_of("hang", 41));
  constexpr std::size_t kCloths = 8;
  std::array<std::uint64_t, kCloths> hashes{};
  tbb::task_arena arena(2);
  arena.execute([&] {
    in_tasks(kCloths, [&](std::size_t i) {
      auto cloth = Cloth::create(model, {});
      if (!cloth) return;
      for (int k = 0; k < 10; ++k) (void)cloth.value().step(0.005);
      hashes[i] = cloth.value().state_hash();
    });
  });
  auto alone = Cloth::create(model, {.threads = 1});
  REQUIRE(alone);
  run(alone.value(), 0.005, 10);
  for (const std::uint64_t hash : hashes) CHECK(hash == alone.value().state_hash());
}

TEST_CASE("a step asks for as many threads as the settings say") {
  const auto model = model_of(scene_of("hang", 64));
  constexpr int kSlots = 4;
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, kSlots);
  tbb::task_arena arena(kSlots);
  for (const int threads : {0, 1, 2, 3, 5}) {
    CAPTURE(threads);
    State state(model, {.substeps = 1,
                        .solver = Solver::gauss_seidel,
                        .isa = resolve(Isa::automatic).value(),
                        .threads = threads});
    arena.execute([&] { step_in_team(state, 0.001, {}); });
    const int expected = threads == 0 ? kSlots : std::min(threads, kSlots);
    const int asked =
        state.team_state ? 1 + static_cast<int>(state.team_state->workers.places()) : 1;
    CHECK(asked == expected);
  }
}

TEST_CASE("a cloth keeps its model alive") {
  const Backend backend = each_backend();
  auto model = model_of(scene_of("hang", 5));
  auto cloth = Cloth::create(model, on(backend));
  REQUIRE(cloth);
  model.reset();
  CHECK(step(cloth.value(), 0.01).status == Status::converged);
}

}  // namespace
}  // namespace weft::test::engine_step_threads
