/// How far a particle may be moved before it can touch a body that moves.
#include "kernels/reference/bodies.h"

#include <doctest/doctest.h>

#include <vector>

#include "engine/bodies/body_shape.h"
#include "engine/bodies/pose.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace weft::test::kernels_reference_bodies {
namespace {

using kernels::Vector;

Vector random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

/// It travels by 10 mm, and turns by 6 degrees, at most.
reference::BodyMotion random_motion(const BodyShape& shape, Random& random) {
  const auto pose = [&] {
    const Vector at = random_vector(random, 5e-3), turn = random_vector(random, 0.05);
    return Pose{{at.x, at.y, at.z}, normalized({turn.x, turn.y, turn.z, 1})};
  };
  const PoseTravel travel(pose(), pose());
  return {.form = shape.form(), .from = travel.at(0), .to = travel.at(1), .thickness = 0.002};
}

TEST_CASE("what is moved by less than it is clear of a body does not touch it") {
  for (const ShapeDescription& description : closed_forms_of_size(0.1)) {
    const auto shape = build_shape(description).value();
    Random random(3);
    int clear_ways = 0, touching = 0, unclear_and_free = 0;
    for (int i = 0; i < 20000; ++i) {
      const reference::BodyMotion body = random_motion(*shape, random);
      const Vector start = random_vector(random, 0.2), x = start + random_vector(random, 0.03);
      const double radius = random.between(0, 1e-3);
      const double clear = reference::clear_of(body, start, x, radius);
      const bool touches = reference::find_touch(body, start, x, radius).is_near;
      if (touches) ++touching;
      if (!(clear > 0)) {
        if (!touches) ++unclear_and_free;
        continue;
      }
      ++clear_ways;
      const auto moved = [&](Vector from) {
        const Vector by = random_vector(random, 1);
        return from + (0.999 * clear / length(by)) * by;
      };
      for (int k = 0; k < 5; ++k)
        REQUIRE(!reference::find_touch(body, moved(start), moved(x), radius).is_near);
    }
    CHECK(touching > 100);
    CHECK(clear_ways > 2000);
    CHECK(unclear_and_free < 4000);  // it is worth asking
  }
}

}  // namespace
}  // namespace weft::test::kernels_reference_bodies
