/// Steps with bodies that move by themselves allocate nothing once warm.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"
#include "tests/support/free_body.h"

namespace weft::test::engine_solvers_small_steps_free_allocation {
namespace {

TEST_CASE("after two seconds a step with bodies that the cloth moves allocates nothing") {
  const SceneDescription scene =
      scenes::make("four_pins", {.size = 13, .material = find_material("cotton").value()}).value();
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  const Free ball = add_free(cloth, Ball{{}, 0.09}, 0.1, {.position = {0.35, 0.12, 0.5}});
  add_free(cloth, weft::box({0.15, 0.16, 0.17}), 0.2, {.position = {0.65, 0.12, 0.52}});
  run(cloth, 1.0 / 60, 120);
  std::size_t failed = 0, touched = 0;
  const std::size_t before = allocations();
  for (int frame = 0; frame < 120; ++frame) {
    failed += !cloth.set_body_force(ball.id, {0.1, 0, 0}, {});
    const auto report = cloth.step(1.0 / 60);
    failed += !report;
    touched += report && report.value().body_contacts > 0;
  }
  const std::size_t after = allocations();
  CHECK(failed == 0);
  CHECK(touched > 60);
  CHECK(after == before);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_free_allocation
