#include "tests/fuzz/stepping.h"

#include <cmath>

#include "tests/fuzz/checks.h"

namespace weft::fuzz {
namespace {

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_finite(const Cloth& cloth) {
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
    check(is_finite(cloth.position(i)), "positions that a step committed are finite");
    check(is_finite(cloth.velocity(i)), "velocities that a step committed are finite");
  }
}

}  // namespace

Settings brief_settings() {
  Settings settings;
  settings.max_iterations = 100;
  settings.threads = 1;
  return settings;
}

void step_twice(Cloth& cloth) {
  for (const double dt : {0.01, 1 / 60.}) {
    const std::uint64_t before = cloth.state_hash();
    const auto report = cloth.step(dt);
    if (!report) {
      check_message(report.error());
      check(cloth.state_hash() == before, "a step that is refused changes nothing");
    } else if (committed(report.value().status)) {
      check_finite(cloth);
    } else {
      check(cloth.state_hash() == before, "a step that does not commit changes nothing");
    }
  }
}

}  // namespace weft::fuzz
