/// Memory that runs out in the middle of a step: the state stays as it was, and the cloth can go
/// on.
#include <doctest/doctest.h>

#include <new>
#include <string>

#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_step_out_of_memory {
namespace {

struct Attempt {
  bool threw = false;
  std::uint64_t before = 0, after = 0;
};

Attempt attempt(Cloth& cloth, std::size_t granted) {
  Attempt result;
  result.before = cloth.state_hash();
  try {
    const FailingAllocations failing(granted);
    (void)cloth.step(0.01);
  } catch (const std::bad_alloc&) {
    result.threw = true;
  }
  result.after = cloth.state_hash();
  return result;
}

/// Steps two clothes, one of them only when as many allocations as it wants were refused it, one
/// after the other: both must go the same way. Returns how many were.
std::size_t refusals(const char* scene, const Settings& settings) {
  Cloth undisturbed = cloth_of(scene_of(scene, 7), settings);
  Cloth cloth = cloth_of(scene_of(scene, 7), settings);
  std::size_t refused = 0;
  for (int k = 0; k < 60; ++k) {
    (void)undisturbed.step(0.01);
    // Each attempt may keep memory that it got: so many allocations are always one more.
    for (std::size_t granted = 0; granted < 3;) {
      const Attempt a = attempt(cloth, granted);
      if (!a.threw) break;
      ++refused;
      REQUIRE(a.after == a.before);
      ++granted;
    }
    while (cloth.state_hash() != undisturbed.state_hash()) {
      const Attempt a = attempt(cloth, 1000);
      REQUIRE_FALSE(a.threw);
      REQUIRE(cloth.state_hash() == undisturbed.state_hash());
    }
  }
  return refused;
}

TEST_CASE("a step without memory changes nothing, and the next one is as if it had not been") {
  for (const Backend backend : kBackends) {
    for (const int substeps : {1, 3}) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(name(backend)));
        CAPTURE(substeps);
        CAPTURE(velocity_correction);
        Settings settings = on(backend);
        settings.substeps = substeps;
        settings.velocity_correction = velocity_correction;
        CHECK(refusals("hang_sphere", settings) > 0);
        CHECK(refusals("sphere_drop", settings) > 0);
      }
    }
  }
}

TEST_CASE("nor does a small step without memory change anything") {
  for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
    CAPTURE(name(scheme));
    const Settings settings{.solver = Solver::small_steps, .scheme = scheme};
    CHECK(refusals("hang_sphere", settings) > 0);
    CHECK(refusals("sphere_drop", settings) > 0);
  }
}

TEST_CASE("a fixed particle that found no memory has not moved, and travels the next time") {
  const auto moved = [](Cloth& cloth) {
    const Vec3 at = cloth.position(11);
    return cloth.move_fixed(11, {at.x, at.y + 0.005, at.z});
  };
  Cloth cloth = cloth_of(scene_of("hang", 12), {});
  const std::uint64_t before = cloth.state_hash();
  for (std::size_t granted = 0; granted < 4; ++granted) {
    const FailingAllocations failing(granted);
    CHECK_THROWS_AS((void)moved(cloth), std::bad_alloc);
  }
  CHECK(cloth.state_hash() == before);
  Cloth untouched = cloth_of(scene_of("hang", 12), {});
  for (Cloth* each : {&cloth, &untouched}) {
    CHECK(moved(*each));
    CHECK(step(*each, 0.01).status == Status::converged);
  }
  CHECK(cloth.state_hash() == untouched.state_hash());
}

TEST_CASE("a change that found no memory is none at all, and can be made the next time") {
  const SceneDescription scene = scene_of("hang", 7);
  Cloth cloth = cloth_of(scene, {});
  run(cloth, 0.01, 5);
  Cloth untouched = cloth.clone();
  const Changes changes{
      .fix = {24}, .release = {scene.fixed[0]}, .masses = {{30, 0.02}}, .compliances = {{5, 1e-3}}};
  const auto model = cloth.model();
  const std::uint64_t before = cloth.state_hash();
  const auto finds_memory = [&](std::size_t granted) {
    try {
      const FailingAllocations failing(granted);
      return static_cast<bool>(cloth.change(changes));
    } catch (const std::bad_alloc&) {
      return false;
    }
  };
  std::size_t granted = 0;
  for (; !finds_memory(granted); granted += 3) {
    REQUIRE(cloth.state_hash() == before);
    REQUIRE(cloth.model() == model);
  }
  CHECK(granted > 100);
  REQUIRE(untouched.change(changes));
  for (Cloth* each : {&cloth, &untouched}) run(*each, 0.01, 3);
  CHECK(cloth.state_hash() == untouched.state_hash());
}

TEST_CASE("forces that found no memory are not half there") {
  Cloth cloth = cloth_of(scene_of("hang", 5), {});
  const std::vector<Vec3> forces(cloth.particle_count(), Vec3{1, 0, 0});
  for (std::size_t granted = 0; granted < 3; ++granted) {
    const FailingAllocations failing(granted);
    CHECK_THROWS_AS((void)cloth.write_forces(forces), std::bad_alloc);
  }
  Cloth untouched = cloth_of(scene_of("hang", 5), {});
  CHECK(step(cloth, 0.01).status == step(untouched, 0.01).status);
  CHECK(cloth.state_hash() == untouched.state_hash());
}

}  // namespace
}  // namespace weft::test::engine_step_out_of_memory
