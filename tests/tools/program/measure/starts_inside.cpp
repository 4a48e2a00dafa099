#include "tools/program/measure/starts_inside.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scenes/body_meshes.h"
#include "tools/scenes/splitmix.h"

namespace weft::tools {
namespace {

/// Points by chance in a cube of 2 m.
SceneDescription cloud() {
  scenes::SplitMix random(3);
  const auto number = [&] { return 2 * random.unit() - 1; };
  SceneDescription scene;
  for (int i = 0; i < 2000; ++i) {
    scene.positions.push_back({number(), number(), number()});
    scene.masses.push_back(1);
  }
  return scene;
}

template <class Inside>
std::size_t count(const SceneDescription& scene, Inside&& inside) {
  return static_cast<std::size_t>(std::ranges::count_if(scene.positions, inside));
}

std::size_t found(const SceneDescription& scene, const SceneBody& body, double depth = 0) {
  const auto starts = starts_inside(scene, {&body, 1}, depth);
  return starts.empty() ? 0 : starts.front().particles;
}

TEST_CASE("what is inside of planes, balls, capsules and boxes is counted where they begin") {
  const SceneDescription scene = cloud();
  CHECK(found(scene, {.shape = Plane{{0, 1, 0}, 0.1}}) ==
        count(scene, [](Vec3 p) { return p.y < 0.1; }));
  CHECK(found(scene, {.shape = Ball{{}, 0.5}, .position = {0.3, 0, 0}}) ==
        count(scene, [](Vec3 p) { return std::hypot(p.x - 0.3, p.y, p.z) < 0.5; }));
  CHECK(found(scene, {.shape = Capsule{{-0.5, 0, 0}, {0.5, 0, 0}, 0.3, 0.3}}, 0.01) ==
        count(scene, [](Vec3 p) {
          return std::hypot(p.x - std::clamp(p.x, -0.5, 0.5), p.y, p.z) < 0.29;
        }));
  const double turn = std::numbers::pi / 2;
  CHECK(found(scene, {.shape = box({1, 0.2, 0.4}), .rotation = {0, 0, turn}}) ==
        count(scene, [](Vec3 p) {
          return std::abs(p.y) < 0.5 && std::abs(p.x) < 0.1 && std::abs(p.z) < 0.2;
        }));
}

TEST_CASE("what is inside of a closed mesh is counted, what lies on it is not") {
  SceneDescription scene = cloud();
  const TriangleMesh ball = scenes::ball_mesh({.radius = 0.5}, 40);
  const double slack = 0.005;  // by which facets are under the ball
  const std::size_t here = found(scene, {.shape = ball, .position = {0.3, 0, 0}});
  const auto within = [&](double radius) {
    return count(scene, [=](Vec3 p) { return std::hypot(p.x - 0.3, p.y, p.z) < radius; });
  };
  CHECK(here <= within(0.5));
  CHECK(here >= within(0.5 - slack));
  TriangleMesh other = ball;
  other.two_sided = true;
  CHECK(found(scene, {.shape = other}) == 0);
  scene.positions = ball.vertices;
  CHECK(found(scene, {.shape = ball}, 1e-4) == 0);
  scene.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.7}};
  CHECK(found(scene, {.shape = ball}) == 3);
  scene.fixed = {0};
  CHECK(found(scene, {.shape = ball}) == 2);
}

TEST_CASE("weft run says at once what begins inside a body") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(folder, "run hang --size 5 --steps 1 --plane 0,1,0,0.1");
  CHECK(outcome.err.find("particles of the cloth begin inside body 0") != std::string::npos);
  const Outcome clear = run_program(folder, "run hang --size 5 --steps 1 --plane 0,1,0,-3");
  CHECK(clear.err.find("inside body") == std::string::npos);
}

}  // namespace
}  // namespace weft::tools
