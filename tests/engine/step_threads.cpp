/// A Model may be shared by any number of Cloths and threads.
#include <doctest/doctest.h>

#include <array>
#include <thread>

#include "tests/support/clothes.h"

namespace weft::test {
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

TEST_CASE("a cloth keeps its model alive") {
  const Backend backend = each_backend();
  auto model = model_of(scene_of("hang", 5));
  auto cloth = Cloth::create(model, on(backend));
  REQUIRE(cloth);
  model.reset();
  CHECK(step(cloth.value(), 0.01).status == Status::converged);
}

}  // namespace
}  // namespace weft::test
