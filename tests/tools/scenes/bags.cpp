/// The bags hold their balls, and no energy comes out of nothing.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::scenes {
namespace {

/// J, of the cloth and of its balls, which do not turn about other points than their centres.
double energy_of(const Cloth& cloth, const std::vector<tools::SceneBody>& balls) {
  double sum = cloth.energy().total();
  for (std::uint32_t id = 0; id < balls.size(); ++id) {
    const auto [v, w] = cloth.body_velocity(id).value();
    const BodyMass& m = *balls[id].mass;
    sum += 0.5 * m.mass * (v.x * v.x + v.y * v.y + v.z * v.z) +
           0.5 * m.inertia[0] * (w.x * w.x + w.y * w.y + w.z * w.z) +
           10 * m.mass * cloth.body_pose(id).value().position.y;
  }
  return sum;
}

/// The bags have moved by so much along x.
void check_held(const Cloth& cloth, const std::vector<tools::SceneBody>& balls, double moved) {
  for (std::uint32_t id = 0; id < balls.size(); ++id) {
    CAPTURE(id);
    const Vec3 from = balls[id].position, to = cloth.body_pose(id).value().position;
    CHECK(to.y > 0);
    CHECK(to.y < 0.3);
    CHECK(std::hypot(to.x - from.x - moved, to.z - from.z) < 0.15);
  }
}

TEST_CASE("bags are lifted and swing, and hold their balls, at three frame rates") {
  const auto [description, mesh, balls, moves] = make_scene("bags", {.size = 13}).value();
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    Cloth cloth = Cloth::create(build_model(description).value(), {.threads = 1}).value();
    REQUIRE(tools::MovedBodies::add(balls, cloth));
    const tools::MovedPins pins(moves, cloth);
    const double before = energy_of(cloth, balls);
    double work = 0;
    for (int frame = 1; frame <= 3 * rate; ++frame) {
      REQUIRE(pins.send(cloth, static_cast<double>(frame) / rate));
      const StepReport report = cloth.step(1. / rate).value();
      REQUIRE(report.status == Status::converged);
      work += report.pin_work;
      REQUIRE(energy_of(cloth, balls) < before + work + 0.02);  // of some 2 J
      if (frame == rate * 3 / 2) check_held(cloth, balls, 0);
    }
    check_held(cloth, balls, 0.3);
    CHECK(work > 1);
  }
}

}  // namespace
}  // namespace weft::scenes
