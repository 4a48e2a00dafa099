/// Substeps allocate nothing either, not even the first time.
#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/counting_new.h"

namespace weft::test::engine_step_substeps_allocation {
namespace {

TEST_CASE("a step in substeps allocates nothing, nor does one that is taken back") {
  Settings settings = on(each_backend());
  settings.substeps = 4;
  Cloth cloth = cloth_of(scene_of("hang", 7), settings);
  const std::size_t before = allocations();
  const auto good = cloth.step(0.01);
  const auto bad = cloth.step(1e100);
  const std::size_t after = allocations();
  REQUIRE(good);
  CHECK(committed(good.value().status));
  REQUIRE(bad);
  CHECK_FALSE(committed(bad.value().status));
  CHECK(after == before);
}

}  // namespace
}  // namespace weft::test::engine_step_substeps_allocation
