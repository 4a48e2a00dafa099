/// Steps of cloth that touches itself allocate nothing once warm.
#include <doctest/doctest.h>

#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"
#include "tests/support/layers.h"

namespace weft::test::engine_contact_self_allocation {
namespace {

TEST_CASE("a warm step of layers on a floor allocates nothing") {
  const SceneDescription scene = scene_of(stack(3, 8, 0.006), 0.3);
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
  const std::vector<Vec3> at_rest(scene.positions.size());
  std::size_t in_steps = 0;
  const auto run_from_start = [&] {
    std::size_t failed = !cloth.write_positions(scene.positions);
    failed += !cloth.write_velocities(at_rest);
    for (std::size_t i = 0; i < 20; ++i) {
      const std::size_t before = allocations();
      failed += !cloth.step(1.0 / 60);
      if (i > 0) in_steps += allocations() - before;
    }
    return failed;
  };
  REQUIRE(run_from_start() == 0);
  REQUIRE(run_from_start() == 0);
  in_steps = 0;
  REQUIRE(run_from_start() == 0);
  CHECK(in_steps == 0);
}

}  // namespace
}  // namespace weft::test::engine_contact_self_allocation
