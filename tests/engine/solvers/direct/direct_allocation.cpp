/// The direct solver allocates nothing once warm either.
#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_solvers_direct_direct_allocation {
namespace {

TEST_CASE("a warm direct step allocates nothing") {
  for (const Backend backend : kBackends) {
    for (const char* name : {"hang", "corners", "sphere_drop"}) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(name));
        Settings settings = on(backend);
        settings.solver = Solver::direct;
        settings.velocity_correction = velocity_correction;
        const SceneDescription scene = scene_of(name, 7);
        const std::vector<Vec3> at_rest(scene.positions.size());
        Cloth cloth = cloth_of(scene, settings);
        run(cloth, 0.01, 200);
        REQUIRE(cloth.write_positions(scene.positions));
        REQUIRE(cloth.write_velocities(at_rest));
        const std::size_t before = allocations();
        for (int k = 0; k < 200; ++k) (void)cloth.step(0.01);
        const std::size_t after = allocations();
        CHECK(after == before);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct_allocation
